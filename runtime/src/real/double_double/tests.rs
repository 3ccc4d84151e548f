//! [`DoubleDouble`] compared with exact integers, identities, and values of another arithmetic.

#![expect(
    clippy::approx_constant,
    reason = "the tables are numbers of another program, letter for letter"
)]

use super::{DoubleDouble, two_product, two_sum};
use crate::Real;

/// u² = 2⁻¹⁰⁶
const U2: f64 = f64::EPSILON * f64::EPSILON / 4.0;

fn dd(value: f64) -> DoubleDouble {
    DoubleDouble::from_f64(value)
}

/// |a − b| as a double: the difference of neighbours is exact.
fn apart(a: DoubleDouble, b: DoubleDouble) -> f64 {
    (a - b).to_f64().abs()
}

#[track_caller]
fn close(ours: DoubleDouble, expected: DoubleDouble, relative: f64) {
    let bound = relative * expected.to_f64().abs();
    let off = apart(ours, expected);
    assert!(
        off <= bound,
        "{ours:?} instead of {expected:?}: {off:e} > {bound:e}"
    );
}

/// Numbers that look random (Knuth's congruential generator), the same ones in every run.
struct Numbers(u64);

impl Numbers {
    fn bits(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 11
    }

    /// Between −1 and 1, in all digits.
    fn unit(&mut self) -> DoubleDouble {
        let part = |bits: u64| bits as f64 * 0.5_f64.powi(52) - 1.0;
        DoubleDouble::new(part(self.bits()), 0.5_f64.powi(54) * part(self.bits()))
    }

    /// Between −`size` and `size`.
    fn within(&mut self, size: f64) -> DoubleDouble {
        self.unit() * dd(size)
    }

    /// Positive, of any size between 10⁻⁶⁰ and 10⁶⁰.
    fn positive(&mut self) -> DoubleDouble {
        let power = 60.0 * self.unit().to_f64();
        (self.unit().abs() + dd(1e-3)) * dd(10.0_f64.powf(power))
    }
}

fn numbers() -> Numbers {
    Numbers(2027)
}

#[test]
fn whole_numbers_of_106_bits_are_exact() {
    let whole = |x: DoubleDouble| x.hi as i128 + x.lo as i128;
    let mut numbers = numbers();
    for _ in 0..10_000 {
        let (a, b, c) = (
            numbers.bits() as i64,
            numbers.bits() as i64,
            numbers.bits() as i64,
        );
        let signed = i128::from(a) * i128::from(b) - i128::from(c);
        let [a, b, c] = [a, b, c].map(|n| dd(n as f64));
        assert_eq!(whole(a * b - c), signed);
        assert_eq!(whole(a.mul_add(b, -c)), signed);
        let (product, error) = two_product(a.hi, b.hi);
        assert_eq!(product as i128 + error as i128, a.hi as i128 * b.hi as i128);
        // the quotient of an exact product is exact within its bound
        close(a * b / b, a, 15.0 * U2);
    }
}

#[test]
fn the_low_part_is_at_most_half_a_digit_of_the_high_one() {
    let mut numbers = numbers();
    for _ in 0..10_000 {
        let (a, b) = (numbers.positive(), numbers.positive());
        for x in [
            a + b,
            a - b,
            a * b,
            a / b,
            a.sqrt(),
            a.ln(),
            numbers.within(700.0).exp(),
        ] {
            assert_eq!(x.hi + x.lo, x.hi, "{x:?}");
            assert_eq!(two_sum(x.hi, x.lo), (x.hi, x.lo));
        }
    }
}

#[test]
fn arithmetic_keeps_its_identities() {
    let mut numbers = numbers();
    for _ in 0..10_000 {
        let (a, b, c) = (numbers.positive(), numbers.positive(), numbers.unit());
        // the bounds are the sums of those of the operations
        let off = apart((a + b) - b, a);
        assert!(
            off <= (3.0 + 3.0) * U2 * (a.to_f64() + b.to_f64()),
            "{a:?} {b:?}"
        );
        close(a * b / b, a, (7.0 + 15.0 + 1.0) * U2);
        close(a / b * b, a, (7.0 + 15.0 + 1.0) * U2);
        close((a * a).sqrt(), a, (3.5 + 8.0 + 1.0) * U2);
        close(a.sqrt() * a.sqrt(), a, (16.0 + 7.0 + 1.0) * U2);
        close(a * (b + b * c * c), a * b + a * b * c * c, 64.0 * U2);
        assert_eq!(a * b, b * a);
        assert_eq!(a + b, b + a);
        assert_eq!(-(a - b), b - a);
    }
}

#[test]
fn functions_keep_their_identities() {
    let mut numbers = numbers();
    for i in 0..2_000 {
        let a = numbers.within([1.0, 10.0, 1e3, 1e6][i % 4]);
        let one = dd(1.0);
        let (sine, cosine) = a.sin_cos();
        close(sine * sine + cosine * cosine, one, (32.0 + 7.0 + 3.0) * U2);
        let (of_twice, _) = (a + a).sin_cos();
        close(
            dd(2.0) * sine * cosine,
            of_twice,
            (3.0 * 16.0 + 7.0 + 1.0) * U2,
        );

        let turn = numbers.within(3.1);
        let (sine, cosine) = turn.sin_cos();
        let size = numbers.positive();
        close(
            (size * sine).atan2(size * cosine),
            turn,
            (48.0 + 2.0 * (16.0 + 7.0)) * U2,
        );

        let b = numbers.within(300.0);
        close(b.exp() * (-b).exp(), one, (16.0 + 16.0 + 7.0 + 1.0) * U2);
        let sum = b + numbers.within(300.0);
        close(
            sum.exp(),
            b.exp() * (sum - b).exp(),
            (3.0 * 16.0 + 7.0 + 3.0 * 600.0) * U2,
        );
        let off = apart(b.exp().ln(), b);
        assert!(off <= (16.0 + 32.0 * b.to_f64().abs()) * U2);
        let log = size.ln();
        close(log.exp(), size, (32.0 * log.to_f64().abs() + 16.0) * U2);

        let p = numbers.within(2.0);
        let bound = 40.0 * (p * log).to_f64().abs() + 16.0;
        close(size.powf(p) * size.powf(-p), one, (2.0 * bound + 7.0) * U2);
        // a power by squaring, compared with one in two parts by exponentials
        let rest = dd(2.5) - p;
        let size_of_parts = (p.to_f64().abs() + rest.to_f64().abs()) * log.to_f64().abs();
        let bound = (40.0 + 3.0) * size_of_parts + 2.0 * 16.0 + 7.0 + (2.5 * 7.0 + 8.0);
        close(
            size.powf(rest) * size.powf(p),
            size.powf(dd(2.5)),
            bound * U2,
        );
    }
}

#[test]
fn small_powers_are_products() {
    let mut numbers = numbers();
    for _ in 0..1_000 {
        let x = numbers.positive();
        assert_eq!(x.powf(dd(0.0)), dd(1.0));
        assert_eq!(x.powf(dd(1.0)), x);
        assert_eq!(x.powf(dd(2.0)), x * x);
        assert_eq!(x.powf(dd(3.0)), x * (x * x));
        assert_eq!(x.powf(dd(0.5)), x.sqrt());
        assert_eq!(x.powf(dd(-1.0)), dd(1.0) / x);
    }
    assert_eq!(
        dd(3.0).powf(dd(40.0)).hi as i128,
        3_i128.pow(40) as f64 as i128
    );
}

#[test]
fn values_are_those_of_another_arithmetic() {
    let of = |[hi, lo]: [f64; 2]| DoubleDouble::new(hi, lo);
    for (x, sine, cosine) in SIN_COS {
        let ours = dd(x).sin_cos();
        close(ours.0, of(sine), 16.0 * U2);
        close(ours.1, of(cosine), 16.0 * U2);
    }
    for (x, sine) in SINE_NEXT_TO_0 {
        close(of(x).sin_cos().0, of(sine), 16.0 * U2);
    }
    for (x, expected) in EXP {
        close(dd(x).exp(), of(expected), 16.0 * U2);
    }
    for (x, expected) in LN {
        close(dd(x).ln(), of(expected), 32.0 * U2);
    }
    for (x, expected) in SQRT {
        close(dd(x).sqrt(), of(expected), 8.0 * U2);
    }
    for ([y, x], expected) in ATAN2 {
        close(dd(y).atan2(dd(x)), of(expected), 48.0 * U2);
    }
    for ([x, p], expected) in POWER {
        let whole = 2.0 * p == (2.0 * p).round() && p.abs() <= 64.0;
        // a power by squaring takes at most |p| products, each in error by the bound of one, and a root or a quotient
        let bound = match whole {
            true => 7.0 * p.abs() + 8.0 + 15.0,
            false => 40.0 * (p * x.ln()).abs() + 16.0,
        };
        close(dd(x).powf(dd(p)), of(expected), bound * U2);
    }
}

#[test]
fn what_is_not_finite_shows_in_the_high_part() {
    let (infinite, nan, huge) = (dd(f64::INFINITY), dd(f64::NAN), dd(1e308));
    let shows = |x: DoubleDouble| !x.hi.is_finite() && x.lo.is_finite() && !x.is_finite();
    for x in [
        huge * dd(10.0),
        huge + huge,
        -huge - huge,
        huge / dd(0.01),
        dd(1.0) / dd(0.0),
        infinite + dd(1.0),
        dd(2.0) * infinite,
        infinite / dd(3.0),
        infinite.sqrt(),
        infinite.exp(),
        dd(710.0).exp(),
        infinite.ln(),
        dd(0.0).ln(),
        dd(0.0).powf(dd(-1.5)),
        dd(0.0).powf(dd(-0.3)),
        huge.powf(dd(2.0)),
        huge.powf(dd(1.3)),
        infinite.abs(),
    ] {
        assert!(shows(x) && !x.hi.is_nan(), "{x:?}");
    }
    for x in [
        infinite - infinite,
        infinite * dd(0.0),
        dd(0.0) / dd(0.0),
        infinite.taint(),
        nan.taint(),
        nan + dd(1.0),
        dd(1.0) / nan,
        nan * dd(0.0),
        nan.sqrt(),
        dd(-1.0).sqrt(),
        dd(-1.0).ln(),
        nan.exp(),
        nan.ln(),
        nan.powf(dd(0.3)),
        nan.powf(dd(2.0)),
        nan.atan2(dd(1.0)),
        dd(1.0).atan2(nan),
        nan.sin_cos().0,
        infinite.sin_cos().1,
        dd(1e16).sin_cos().0,
        nan.max(dd(1.0)),
        nan.min(dd(1.0)),
    ] {
        assert!(shows(x) && x.hi.is_nan(), "{x:?}");
    }
    for (x, expected) in [
        (dd(1.0) / infinite, 0.0),
        ((-infinite).exp(), 0.0),
        (dd(-800.0).exp(), 0.0),
        (dd(0.0).powf(dd(0.3)), 0.0),
        (dd(0.0).sqrt(), 0.0),
        (dd(0.0).atan2(dd(0.0)), 0.0),
        (dd(0.0) / dd(3.0), 0.0),
        (dd(1e300) * dd(1e-300) - dd(1.0), 0.0),
        (dd(1.0).atan2(infinite), 0.0),
    ] {
        assert!((x.to_f64() - expected).abs() <= f64::EPSILON, "{x:?}");
    }
    // far out, the value still has at least double precision
    let product = dd(1.5e308) * dd(0.7);
    assert!(product.is_finite() && (product.to_f64() / 1.05e308 - 1.0).abs() <= f64::EPSILON);
}

#[test]
fn angles_lie_in_the_quadrants_of_the_library() {
    let axis = [f64::NEG_INFINITY, -2.0, -0.0, 0.0, 1.5, f64::INFINITY];
    for y in axis {
        for x in axis {
            let ours = dd(y).atan2(dd(x)).to_f64();
            let library = y.atan2(x);
            assert!(
                (ours - library).abs() <= 2.0 * f64::EPSILON * library.abs(),
                "{y} {x}: {ours}"
            );
            assert_eq!(ours.is_sign_negative(), library.is_sign_negative());
        }
    }
}

#[test]
fn comparison_looks_at_all_digits() {
    let one = dd(1.0);
    let more = one + dd(1e-30);
    assert!(one.lt(more) && !more.lt(one) && !one.lt(one));
    assert_eq!([one.max(more), one.min(more)], [more, one]);
    assert_eq!((-more).abs(), more);
    assert_eq!(more.to_f64(), 1.0);
    assert!(!dd(f64::NAN).lt(one) && !one.lt(dd(f64::NAN)));
    let [hi, lo] = DoubleDouble::new(1e-30, 1.0).parts();
    assert_eq!([hi, lo], [1.0, 1e-30]);
}

// The values of the tables were computed with mpmath 1.3 in 60 digits at the doubles given. Each is split into a double
// and the double nearest to the rest.

/// x, sin x, cos x
const SIN_COS: [(f64, [f64; 2], [f64; 2]); 22] = [
    (1e-20, [1e-20, -1.6666666666666664e-61], [1.0, -5e-41]),
    (3e-09, [3e-09, -4.5e-27], [1.0, -4.5e-18]),
    (
        0.000125,
        [0.00012499999967447917, 8.297333641371886e-23],
        [0.9999999921875, -9.552140633592556e-18],
    ),
    (
        0.01,
        [0.009999833334166664, 4.265611722485374e-19],
        [0.9999500004166653, 1.4419580861217068e-17],
    ),
    (
        0.1,
        [0.09983341664682815, 3.08001512929492e-18],
        [0.9950041652780258, -5.50210156918377e-17],
    ),
    (
        0.3,
        [0.29552020666133955, 1.8315357276792536e-17],
        [0.955336489125606, 4.1935600297907467e-17],
    ),
    (
        0.625,
        [0.5850972729404622, -5.4883972461161805e-17],
        [0.8109631195052179, -3.091333486122179e-17],
    ),
    (
        0.8,
        [0.7173560908995228, 1.1851419720716684e-18],
        [0.6967067093471654, 1.9275818349860986e-18],
    ),
    (
        1.1,
        [0.8912073600614354, -3.605930522940284e-17],
        [0.4535961214255773, -5.78481191353792e-18],
    ),
    (
        1.6,
        [0.9995736030415051, 5.1870146867022216e-17],
        [-0.029199522301288815, 4.155359463897964e-19],
    ),
    (
        2.4,
        [0.675463180551151, 3.7481413187086274e-17],
        [-0.7373937155412454, 2.8862207066333747e-18],
    ),
    (
        3.2,
        [-0.058374143427580086, -6.843928806154204e-19],
        [-0.9982947757947531, 4.547631321586028e-17],
    ),
    (
        -0.45,
        [-0.43496553411123023, 1.3830964123766835e-17],
        [0.9004471023526769, 2.9923681194837105e-17],
    ),
    (
        -4.75,
        [0.999292788975378, -4.3246848321124294e-17],
        [0.03760215288797655, 1.5183050472745252e-18],
    ),
    (
        11.0,
        [-0.9999902065507035, 1.8356150460298835e-17],
        [0.004425697988050785, 3.2449142686784373e-19],
    ),
    (
        100.3,
        [-0.22891692244520673, 2.6396031437971418e-18],
        [0.9734459628650248, -4.412772653826556e-17],
    ),
    (
        355.0,
        [-3.014435335948845e-05, 1.3012643991046347e-21],
        [-0.999999999545659, 1.0574612846643521e-17],
    ),
    (
        -2049.7,
        [-0.9821537916216749, -2.139691699571257e-17],
        [0.18807958316406248, -1.8764745158283975e-18],
    ),
    (
        123456.789,
        [-0.9986640823432246, 4.3073133377883266e-17],
        [0.05167253271870138, -6.512424953386242e-19],
    ),
    (
        1000000.0,
        [-0.34999350217129294, -1.5952848809323968e-17],
        [0.9367521275331447, 4.637088260214747e-17],
    ),
    (
        987654321.0,
        [0.9997954029035435, -4.3283669181054395e-17],
        [-0.02022751425512223, -1.5018682349979417e-18],
    ),
    (
        1000000000000000.0,
        [0.8582727931702359, -2.372639689262412e-17],
        [-0.5131937377869703, 5.3179977268261675e-17],
    ),
];
/// x, e^x
const EXP: [(f64, [f64; 2]); 22] = [
    (1e-25, [1.0, 1e-25]),
    (-3e-12, [0.999999999997, 4.4657146597861926e-17]),
    (1e-05, [1.00001000005, 9.70188425858504e-17]),
    (-0.002, [0.9980019986673331, -1.2248846690536196e-17]),
    (0.1, [1.1051709180756477, -8.149523913327619e-17]),
    (0.34, [1.4049475905635938, 8.000517253714439e-17]),
    (0.35, [1.4190675485932571, 9.472477310898604e-17]),
    (-0.5, [0.6065306597126334, -6.593178415491414e-19]),
    (0.7, [2.0137527074704766, -2.0058243549764793e-16]),
    (1.0, [2.718281828459045, 1.4456468917292502e-16]),
    (-1.5, [0.22313016014842982, 1.0887723699042263e-17]),
    (2.0, [7.38905609893065, -1.7971139497839148e-16]),
    (3.75, [42.52108200006278, -3.2371687033598516e-16]),
    (-8.1, [0.0003035391380788668, -7.69266696232432e-21]),
    (20.3, [654904512.1532385, -3.0349228449237955e-08]),
    (-50.25, [1.5021118919431522e-22, 1.2292264144650188e-39]),
    (100.7, [5.413203172330057e+43, 2.0011273844199142e+27]),
    (-230.4, [8.680632480186867e-101, -4.230592720578419e-117]),
    (500.9, [3.4522797858264433e+217, 1.5399347321837787e+201]),
    (-600.6, [1.4545684685522307e-261, 5.222652449685806e-278]),
    (690.0, [4.60460640478299e+299, -6.285894804412413e+282]),
    (-660.0, [2.3208225941796005e-287, 1.2846860922925439e-303]),
];
/// x, ln x
const LN: [(f64, [f64; 2]); 22] = [
    (1e-280, [-644.7238260383328, 5.3633111285271455e-14]),
    (1e-100, [-230.25850929940458, 1.1069413097223595e-14]),
    (3e-20, [-44.95308957121281, 3.2361929981487893e-15]),
    (1e-05, [-11.512925464970229, 2.790027459050308e-16]),
    (0.02, [-3.912023005428146, -7.69531177859437e-17]),
    (0.3, [-1.2039728043259361, 8.935521583403776e-17]),
    (0.5, [-0.6931471805599453, -2.3190468138462996e-17]),
    (0.7, [-0.35667494393873245, 4.82556379937662e-18]),
    (0.72, [-0.3285040669720361, 7.733514081347257e-18]),
    (0.99, [-0.01005033585350145, 4.341832787901688e-19]),
    (0.9999999, [-1.0000000494736474e-07, -5.529865283193222e-24]),
    (
        1.0000000001,
        [1.000000082690371e-10, -4.2169170658954805e-27],
    ),
    (1.001, [0.0009995003330834232, -6.782451268011377e-20]),
    (1.2, [0.1823215567939546, -3.0417259671808158e-18]),
    (1.41, [0.34358970439007686, -2.001182163029091e-18]),
    (1.42, [0.35065687161316933, -1.7065275145611344e-17]),
    (2.0, [0.6931471805599453, 2.3190468138462996e-17]),
    (5.5, [1.7047480922384253, -3.7526586818263424e-17]),
    (10.0, [2.302585092994046, -2.1707562233822494e-16]),
    (1234.5, [7.118421308785234, -1.865350488379875e-16]),
    (6e+23, [54.751216608091106, -3.629618051085494e-17]),
    (1e+200, [460.51701859880916, -2.2129109272629473e-14]),
];
/// (y, x), angle of the point
const ATAN2: [([f64; 2], [f64; 2]); 22] = [
    ([1e-20, 1.0], [1e-20, -3.333333333333333e-61]),
    (
        [1e-05, 3.0],
        [3.333333333320988e-06, 1.0853828380136003e-22],
    ),
    ([0.1, 1.0], [0.09966865249116204, -5.190520336352787e-18]),
    ([0.2, 0.5], [0.3805063771123649, 3.540779945587601e-18]),
    ([0.7, 0.9], [0.6610431688506868, 1.879618417426066e-17]),
    ([1.0, 1.0], [0.7853981633974483, 3.061616997868383e-17]),
    ([1.0, 0.9], [0.83798122500839, 8.17553104938516e-18]),
    ([3.0, 0.25], [1.4876550949064553, 7.844371739461077e-17]),
    ([5.0, 1e-09], [1.5707963265948965, 7.778041414473208e-17]),
    ([1.0, 0.0], [1.5707963267948966, 6.123233995736766e-17]),
    ([1.0, -1e-07], [1.5707964267948966, 2.8452844159665555e-18]),
    ([2.0, -0.3], [1.719686274404394, -5.756625892397957e-17]),
    ([1.5, -1.5], [2.356194490192345, 9.184850993605148e-17]),
    ([0.3, -2.0], [2.992702705980296, 1.921867387105124e-17]),
    ([1e-12, -1.0], [3.141592653588793, 2.1136526225576705e-16]),
    (
        [-1e-12, -1.0],
        [-3.141592653588793, -2.1136526225576705e-16],
    ),
    ([-0.4, -0.6], [-2.5535900500422257, 7.858753703642302e-17]),
    ([-3.0, -0.1], [-1.6041173226731438, -4.314441192814148e-17]),
    ([-2.0, 0.001], [-1.5702963268365633, 3.542644744518102e-18]),
    ([-0.7, 0.6], [-0.8621700546672263, -4.252893515276918e-17]),
    (
        [-0.001, 7.0],
        [-0.00014285714188532557, -4.7503092165029476e-21],
    ),
    (
        [1e+200, 3e+199],
        [1.2793395323170296, -5.911998139703453e-17],
    ),
];
/// (x, p), x^p
const POWER: [([f64; 2], [f64; 2]); 22] = [
    ([0.3, 0.1], [0.8865681505652133, 5.451123671888202e-18]),
    ([0.3, -0.7], [2.32281767311983, -8.129253582728369e-17]),
    ([2.0, 0.3], [1.2311444133449163, -3.572339831433251e-17]),
    ([2.0, 100.7], [2.0593044755556034e+30, -39899919515258.91]),
    ([1.1, 333.3], [62543468616071.97, -0.00011140853471292375]),
    ([0.9, -70.1], [1612.872690109193, -3.908228500381172e-14]),
    (
        [1e-10, 0.4],
        [9.999999999999995e-05, -2.5243681350372074e-22],
    ),
    (
        [1e-10, 3.3],
        [1.0000000000000042e-33, 4.910512470433178e-50],
    ),
    ([5.5, 7.0], [152243.5234375, 0.0]),
    ([5.5, -3.0], [0.006010518407212622, -3.2452753232022914e-19]),
    ([5.5, 2.5], [70.94253836732938, -4.556809240963192e-15]),
    ([7.0, 0.5], [2.6457513110645907, -1.2566948082017735e-16]),
    ([7.0, -0.5], [0.37796447300922725, -2.588294743591931e-17]),
    ([1.7, 64.0], [560700532060105.0, -0.012099608591156417]),
    ([1.7, 65.0], [953190904502178.5, -0.045469440229474085]),
    (
        [0.02, 1.001],
        [0.019921912379762076, 1.5726795556907934e-19],
    ),
    ([123.456, 0.01], [1.0493373274034856, -4.80327772548252e-17]),
    (
        [1000000.0, 1.25],
        [31622776.60168379, 1.5931613139843662e-09],
    ),
    (
        [1000000.0, -2.75],
        [3.1622776601683796e-17, -2.276000809078947e-33],
    ),
    ([0.5, 0.123], [0.9182761623009238, -2.448751302870397e-17]),
    (
        [1e+100, 1.1],
        [1.0000000000000205e+110, -8.051271939054624e+93],
    ),
    (
        [1e-100, 1.1],
        [9.999999999999795e-111, 5.3849681052834085e-127],
    ),
];
/// x, √x
const SQRT: [(f64, [f64; 2]); 20] = [
    (2.0, [1.4142135623730951, -9.667293313452913e-17]),
    (3.0, [1.7320508075688772, 1.0035084221806903e-16]),
    (0.1, [0.31622776601683794, 8.004969469767158e-19]),
    (10.0, [3.1622776601683795, -1.9078816970716603e-16]),
    (1e-300, [1e-150, 6.234187685431415e-168]),
    (1e+300, [1e+150, 4.5416783955164837e+133]),
    (5e-324, [2.2227587494850775e-162, 0.0]),
    (1.7e+308, [1.3038404810405297e+154, 5.536075370638547e+137]),
    (0.3, [0.5477225575051661, 2.890126723719787e-17]),
    (123456.789, [351.3641828644462, 1.5673839756619315e-14]),
    (1e-20, [1e-10, -6.385556158839296e-27]),
    (7e+19, [8366600265.340755, 1.7135235882851876e-08]),
    (1.0000000000000002, [1.0, 1.1102230246251565e-16]),
    (
        0.9999999999999999,
        [0.9999999999999999, 5.551115123125783e-17],
    ),
    (4.5, [2.1213203435596424, 1.8805750768575327e-16]),
    (1e+100, [1e+50, -6.834625285603891e+33]),
    (1e-100, [1e-50, 2.379726195519099e-68]),
    (3e-05, [0.005477225575051661, -9.536926874525442e-20]),
    (99.0, [9.9498743710662, 1.1739767929486026e-16]),
    (65537.0, [256.0019531175495, -5.420952960447279e-19]),
];

/// Multiples of π rounded to a double-double, and their sines, which are the rounding errors.
const SINE_NEXT_TO_0: [([f64; 2], [f64; 2]); 5] = [
    (
        [3.141592653589793, 1.2246467991473532e-16],
        [-2.9947698097183397e-33, 1.1124542208633653e-49],
    ),
    (
        [6.283185307179586, 2.4492935982947064e-16],
        [5.989539619436679e-33, -2.2249084417267306e-49],
    ),
    (
        [3141.5926535897934, -1.3333070495890074e-13],
        [7.136289562128651e-30, 4.470844347930828e-46],
    ),
    (
        [999997.2159715135, -3.895427017286711e-11],
        [2.756035748697427e-27, 4.581752337644828e-44],
    ),
    (
        [3141592653.589793, 3.32014129145295e-08],
        [-1.0692774909120274e-24, 6.386854115724639e-41],
    ),
];
