//! Elementary functions of [`DoubleDouble`]: argument reduction, and the series of Taylor, Gregory and the inverse
//! hyperbolic tangent with coefficients computed at compile time.
//!
//! Relative errors, as sums of the errors of the operations (u = 2⁻⁵³): square root 8 u², sine and cosine 16 u²,
//! exponential 16 u², logarithm 32 u², angle 48 u², power (40 |p ln x| + 16) u², where u² = 1.2·10⁻³².

use super::{DoubleDouble, two_product, two_sum};
use crate::Real;

/// 1.5 · 2⁵²: adding and subtracting it rounds to the nearest whole number.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// π/2 in five parts, 265 bits. An argument may be equal to a multiple of π/2 in all its digits; this many bits still
/// leave a remainder.
const QUARTER_TURN: [f64; 5] = [
    core::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
    5.562_271_104_316_826e-50,
    2.836_115_989_820_158e-66,
];
/// ln 2 in three parts, 159 bits.
const LN_2: [f64; 3] = [
    core::f64::consts::LN_2,
    2.319_046_813_846_299_6e-17,
    5.707_708_438_416_212e-34,
];
const HALF_PI: DoubleDouble = DoubleDouble {
    hi: QUARTER_TURN[0],
    lo: QUARTER_TURN[1],
};
const PI: DoubleDouble = DoubleDouble {
    hi: 2.0 * QUARTER_TURN[0],
    lo: 2.0 * QUARTER_TURN[1],
};

/// Terms of the series of sine, cosine and exponential: 0.79²⁹/29! and 0.35²⁴/24! are below 10⁻³³.
const TERMS: usize = 30;
/// 1/n!
const OVER_FACTORIAL: [DoubleDouble; TERMS] = {
    let mut table = [DoubleDouble::ONE; TERMS];
    let mut n = 2;
    while n < TERMS {
        table[n] = table[n - 1].over(n as f64);
        n += 1;
    }
    table
};
/// Terms of the series of the logarithm: 0.172⁴⁶/47 is below 10⁻³³.
const ODD_TERMS: usize = 23;
/// 1/(2n + 1)
const OVER_ODD: [DoubleDouble; ODD_TERMS] = {
    let mut table = [DoubleDouble::ONE; ODD_TERMS];
    let mut n = 1;
    while n < ODD_TERMS {
        table[n] = DoubleDouble::ONE.over(2.0 * n as f64 + 1.0);
        n += 1;
    }
    table
};

#[inline(never)]
pub(super) fn sqrt(a: DoubleDouble) -> DoubleDouble {
    // 0, −0, ∞ and NaN are their own roots
    if a.hi == 0.0 || a.hi == f64::INFINITY || a.hi.is_nan() {
        return a;
    }
    if a.hi < 0.0 {
        return DoubleDouble::NAN;
    }
    // far from the ends of the range, where no square loses digits
    if a.hi < 1e-250 {
        return sqrt(a.scaled(600)).scaled(-300);
    }
    if a.hi > 1e250 {
        return sqrt(a.scaled(-600)).scaled(300);
    }
    // 1/√a: halving the exponent gives it within 4 %, and each Newton step squares the error: 2·10⁻³, 5·10⁻⁶, 3·10⁻¹¹,
    // ε
    let mut inverse = f64::from_bits(0x5fe6_eb50_c7b5_37a9 - (a.hi.to_bits() >> 1));
    for _ in 0..4 {
        inverse *= 1.5 - 0.5 * a.hi * inverse * inverse;
    }
    // Heron's step twice, with an exact remainder (Karp and Markstein 1997): the first rounds the root to a double
    let correction = |root: f64| {
        let (square, error) = two_product(root, root);
        0.5 * inverse * (((a.hi - square) - error) + a.lo)
    };
    let root = a.hi * inverse;
    let root = root + correction(root);
    DoubleDouble::settled(root, correction(root))
}

/// (sin, cos); NaN beyond 2⁵⁰.
#[inline(never)]
pub(super) fn sin_cos(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    /// 2⁵⁰: up to here the number of quarter turns is exact, and π/2 has enough bits.
    const LARGEST: f64 = 1_125_899_906_842_624.0;
    if x.hi.is_nan() || x.hi.abs() > LARGEST {
        return (DoubleDouble::NAN, DoubleDouble::NAN);
    }
    let quarters = (x.hi * core::f64::consts::FRAC_2_PI + ROUND) - ROUND;
    let (sine, cosine) = sin_cos_of_eighth(remainder(x, quarters, &QUARTER_TURN));
    match quarters as i64 & 3 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// (sin, cos) of `r`, where |`r`| is at most slightly above π/4: Taylor's series by Horner's rule.
fn sin_cos_of_eighth(r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let minus = -(r * r);
    let mut sine = DoubleDouble::ZERO;
    let mut cosine = DoubleDouble::ZERO;
    for n in (1..TERMS / 2).rev() {
        sine = (sine + OVER_FACTORIAL[2 * n + 1]) * minus;
        cosine = (cosine + OVER_FACTORIAL[2 * n]) * minus;
    }
    (r + r * sine, DoubleDouble::ONE + cosine)
}

/// x − `count` · π/2, or another constant that the parts add up to. All digits are exact, even where only the last ones
/// remain: exact products, added by sums without loss (Ogita, Rump and Oishi 2005, with four passes).
fn remainder(x: DoubleDouble, count: f64, parts: &[f64]) -> DoubleDouble {
    let mut terms = [0.0; 12];
    let mut last = 0;
    // from small to large
    for part in parts.iter().rev() {
        let (product, error) = two_product(-count, *part);
        terms[last] = error;
        terms[last + 1] = product;
        last += 2;
    }
    terms[last] = x.lo;
    terms[last + 1] = x.hi;
    last += 1;
    for _ in 0..4 {
        for i in 1..=last {
            (terms[i], terms[i - 1]) = two_sum(terms[i], terms[i - 1]);
        }
    }
    let mut rest = 0.0;
    for term in &terms[..last] {
        rest += term;
    }
    let (hi, lo) = two_sum(terms[last], rest);
    DoubleDouble { hi, lo }
}

/// x = k ln 2 + r with |r| ≤ ln 2/2: e^x = 2ᵏ e^r, by Taylor's series.
#[inline(never)]
pub(super) fn exp(x: DoubleDouble) -> DoubleDouble {
    // beyond, the result is 0 or ∞ in any case
    if x.hi.is_nan() || x.hi > 710.0 || x.hi < -746.0 {
        return DoubleDouble {
            hi: if x.hi < 0.0 {
                0.0
            } else {
                x.hi * f64::INFINITY
            },
            lo: 0.0,
        };
    }
    let count = (x.hi * core::f64::consts::LOG2_E + ROUND) - ROUND;
    let r = remainder(x, count, &LN_2);
    let mut sum = DoubleDouble::ZERO;
    for term in OVER_FACTORIAL[1..26].iter().rev() {
        sum = (sum + *term) * r;
    }
    (DoubleDouble::ONE + sum).scaled(count as i32)
}

/// x = 2ᵏ m with √½ < m ≤ √2: ln x = k ln 2 + 2 artanh((m − 1)/(m + 1)).
#[inline(never)]
pub(super) fn ln(x: DoubleDouble) -> DoubleDouble {
    if x.hi == f64::INFINITY || x.hi.is_nan() {
        return x;
    }
    if x.hi <= 0.0 {
        return DoubleDouble {
            hi: if x.hi == 0.0 {
                f64::NEG_INFINITY
            } else {
                f64::NAN
            },
            lo: 0.0,
        };
    }
    if x.hi < f64::MIN_POSITIVE {
        return ln_of_normal(x.scaled(64), -64);
    }
    ln_of_normal(x, 0)
}

/// ln(x 2^`shift`), x a normal number.
fn ln_of_normal(x: DoubleDouble, shift: i32) -> DoubleDouble {
    let mut exponent = (x.hi.to_bits() >> 52) as i32 - 1023;
    let mut m = x.scaled(-exponent);
    if m.hi > core::f64::consts::SQRT_2 {
        m = m.scaled(-1);
        exponent += 1;
    }
    let z = (m - DoubleDouble::ONE) / (m + DoubleDouble::ONE);
    let z2 = z * z;
    let mut sum = DoubleDouble::ZERO;
    for term in OVER_ODD[1..].iter().rev() {
        sum = (sum + *term) * z2;
    }
    let half = z + z * sum;
    remainder(half + half, -f64::from(exponent + shift), &LN_2)
}

/// `x` to the power `power`: by squaring for whole exponents up to 64, with a square root for their halves; otherwise
/// e^(p ln x).
#[inline(never)]
pub(super) fn powf(x: DoubleDouble, power: DoubleDouble) -> DoubleDouble {
    let size = power.hi.abs();
    if power.lo == 0.0 && size <= 64.0 {
        let doubled = (2.0 * size) as u32;
        if f64::from(doubled) == 2.0 * size {
            let root = if doubled & 1 == 1 {
                sqrt(x)
            } else {
                DoubleDouble::ONE
            };
            let result = root * whole_power(x, doubled / 2);
            return if power.hi < 0.0 {
                DoubleDouble::ONE / result
            } else {
                result
            };
        }
    }
    exp(power * ln(x))
}

fn whole_power(x: DoubleDouble, power: u32) -> DoubleDouble {
    let (mut result, mut square, mut left) = (DoubleDouble::ONE, x, power);
    while left > 0 {
        if left & 1 == 1 {
            result = result * square;
        }
        left >>= 1;
        if left > 0 {
            square = square * square;
        }
    }
    result
}

/// Angle of the point (`x`, `y`). An angle θ₀ in double precision is refined to the last digits by turning the point
/// back by θ₀: θ = θ₀ + arctan((y cos θ₀ − x sin θ₀)/(x cos θ₀ + y sin θ₀)).
#[inline(never)]
pub(super) fn atan2(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    if y.hi.is_nan() || x.hi.is_nan() {
        return DoubleDouble::NAN;
    }
    let (up, right) = (y.abs(), x.abs());
    let steep = right.lt(up);
    let (short, long) = if steep { (right, up) } else { (up, right) };
    // in the first eighth of a turn; a point at infinity lies on an axis or a diagonal
    let angle = if short.hi == f64::INFINITY {
        HALF_PI.scaled(-1)
    } else if long.hi == 0.0 {
        DoubleDouble::ZERO
    } else {
        arctan(short / long)
    };
    let angle = if steep { HALF_PI - angle } else { angle };
    let angle = if x.hi.is_sign_negative() {
        PI - angle
    } else {
        angle
    };
    if y.hi.is_sign_negative() {
        -angle
    } else {
        angle
    }
}

/// arctan `t`, 0 ≤ t ≤ 1.
fn arctan(t: DoubleDouble) -> DoubleDouble {
    /// arctan t/t by powers of t², with a relative error below 2·10⁻⁸ (Abramowitz and Stegun 4.4.49).
    const START: [f64; 9] = [
        1.0,
        -0.333_331_452_8,
        0.199_935_508_5,
        -0.142_088_994_4,
        0.106_562_639_3,
        -0.075_289_640_0,
        0.042_909_613_8,
        -0.016_165_736_7,
        0.002_866_225_7,
    ];
    let t2 = t.hi * t.hi;
    let mut start = 0.0;
    for coefficient in START.iter().rev() {
        start = start * t2 + coefficient;
    }
    let start = DoubleDouble::from_f64(start * t.hi);
    let (sine, cosine) = sin_cos_of_eighth(start);
    let across = (t * cosine - sine) / (cosine + t * sine);
    // the term of the fifth power in the series of arctan is below 10⁻³⁹
    let third = across * across * across * OVER_ODD[1];
    start + (across - third)
}
