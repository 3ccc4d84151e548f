//! Units: their factors to SI and their dimensions.
//!
//! A dimension is a product of powers m^a kg^b s^c K^d; the radian is carried along to name units (N·m·s/rad) but does
//! not count when dimensions are compared.

use std::fmt;
use std::ops::{Div, Mul};

/// Powers of metre, kilogram, second, kelvin; and of radian, which is ignored in comparisons.
#[derive(Clone, Copy, Debug, Default)]
pub struct Dimension {
    m: i32,
    kg: i32,
    s: i32,
    k: i32,
    rad: i32,
}

impl PartialEq for Dimension {
    fn eq(&self, other: &Self) -> bool {
        (self.m, self.kg, self.s, self.k) == (other.m, other.kg, other.s, other.k)
    }
}

impl Dimension {
    /// m^`m` kg^`kg` s^`s` rad^`rad`
    pub const fn new(m: i32, kg: i32, s: i32, rad: i32) -> Self {
        let k = 0;
        Dimension { m, kg, s, k, rad }
    }

    /// The power of the radian, which names units and makes no difference otherwise.
    pub const fn radians(self) -> i32 {
        self.rad
    }

    /// The same times K^`k`.
    pub const fn kelvin(self, k: i32) -> Self {
        Dimension { k, ..self }
    }

    /// A pure number.
    pub const ONE: Dimension = Dimension::new(0, 0, 0, 0);

    /// `power` times over; powers beyond what a formula holds saturate.
    pub fn power(self, power: i32) -> Self {
        let of = |exponent: i32| exponent.saturating_mul(power);
        Dimension::new(of(self.m), of(self.kg), of(self.s), of(self.rad)).kelvin(of(self.k))
    }

    /// The SI unit where its combination has a name, "" where it has none.
    pub fn name(self) -> &'static str {
        let named = NAMED.iter().find(|(d, _)| *d == self && d.rad == self.rad);
        named.map_or("", |(_, name)| name)
    }

    /// The dimension whose square this is.
    pub fn root(self) -> Option<Self> {
        let half = |e: i32| (e % 2 == 0).then_some(e / 2);
        let root = Dimension::new(half(self.m)?, half(self.kg)?, half(self.s)?, self.rad / 2);
        Some(root.kelvin(half(self.k)?))
    }
}

impl Mul for Dimension {
    type Output = Dimension;
    fn mul(self, o: Self) -> Self {
        let sum = i32::saturating_add;
        Dimension::new(
            sum(self.m, o.m),
            sum(self.kg, o.kg),
            sum(self.s, o.s),
            sum(self.rad, o.rad),
        )
        .kelvin(sum(self.k, o.k))
    }
}

impl Div for Dimension {
    type Output = Dimension;
    fn div(self, other: Self) -> Self {
        self * other.power(-1)
    }
}

/// The names of combinations that have one; the radian counts here.
const NAMED: [(Dimension, &str); 24] = [
    (Dimension::new(1, 0, 0, 0), "m"),
    (Dimension::new(2, 0, 0, 0), "m^2"),
    (Dimension::new(0, 1, 0, 0), "kg"),
    (Dimension::new(0, 0, 1, 0), "s"),
    (Dimension::new(0, 0, 0, 0).kelvin(1), "K"),
    (Dimension::new(3, 0, 0, 0), "m^3"),
    (Dimension::new(0, 0, 0, 1), "rad"),
    (Dimension::new(0, 0, -1, 0), "1/s"),
    (Dimension::new(0, 0, -1, 1), "rad/s"),
    (Dimension::new(0, 0, -2, 1), "rad/s^2"),
    (Dimension::new(1, 0, -1, 0), "m/s"),
    (Dimension::new(1, 0, -2, 0), "m/s^2"),
    (Dimension::new(1, 1, -2, 0), "N"),
    (Dimension::new(2, 1, -2, 0), "N*m"),
    (Dimension::new(2, 1, -2, -1), "N*m/rad"),
    (Dimension::new(2, 1, -1, 0), "N*m*s"),
    (Dimension::new(2, 1, -1, -1), "N*m*s/rad"),
    (Dimension::new(0, 1, -2, 0), "N/m"),
    (Dimension::new(0, 1, -1, 0), "N*s/m"),
    (Dimension::new(1, 1, -1, 0), "kg*m/s"),
    (Dimension::new(2, 1, 0, 0), "kg*m^2"),
    (Dimension::new(2, 1, -3, 0), "W"),
    (Dimension::new(-1, 1, -2, 0), "Pa"),
    (Dimension::new(-3, 1, 0, 0), "kg/m^3"),
];

impl fmt::Display for Dimension {
    /// The SI unit as text, "" for a pure number.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some((_, name)) = NAMED.iter().find(|(d, _)| d == self && d.rad == self.rad) {
            return f.write_str(name);
        }
        let bases = [
            (self.kg, "kg"),
            (self.m, "m"),
            (self.s, "s"),
            (self.k, "K"),
            (self.rad, "rad"),
        ];
        let side = |sign: i32| {
            bases
                .iter()
                .filter(|(e, _)| e.signum() == sign)
                .map(|&(e, name)| match e.abs() {
                    1 => name.to_owned(),
                    e => format!("{name}^{e}"),
                })
                .collect::<Vec<_>>()
        };
        let (over, under) = (side(1).join("*"), side(-1));
        if over.is_empty() && !under.is_empty() {
            f.write_str("1")?;
        }
        f.write_str(&over)?;
        under.iter().try_for_each(|unit| write!(f, "/{unit}"))
    }
}

/// A unit: what one of it is in SI, and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// SI value of one unit.
    pub factor: f64,
    /// Dimension.
    pub dimension: Dimension,
}

/// Standard gravity \[m/s²\] (CGPM 1901).
pub const STANDARD_GRAVITY: f64 = 9.80665;

/// Units that take the prefixes n, µ, m, c, d, k, M, G.
const PREFIXED: [(&str, f64, Dimension); 9] = [
    ("m", 1.0, Dimension::new(1, 0, 0, 0)),
    ("g", 1e-3, Dimension::new(0, 1, 0, 0)),
    ("s", 1.0, Dimension::new(0, 0, 1, 0)),
    ("N", 1.0, Dimension::new(1, 1, -2, 0)),
    ("J", 1.0, Dimension::new(2, 1, -2, 0)),
    ("W", 1.0, Dimension::new(2, 1, -3, 0)),
    ("Pa", 1.0, Dimension::new(-1, 1, -2, 0)),
    ("Hz", 1.0, Dimension::new(0, 0, -1, 0)),
    ("rad", 1.0, Dimension::new(0, 0, 0, 1)),
];

const PREFIXES: [(&str, f64); 10] = [
    ("n", 1e-9),
    ("u", 1e-6),
    ("µ", 1e-6),
    ("μ", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
];

/// Units without prefixes.
const PLAIN: [(&str, f64, Dimension); 11] = [
    (
        "deg",
        std::f64::consts::PI / 180.0,
        Dimension::new(0, 0, 0, 1),
    ),
    (
        "°",
        std::f64::consts::PI / 180.0,
        Dimension::new(0, 0, 0, 1),
    ),
    (
        "rpm",
        std::f64::consts::PI / 30.0,
        Dimension::new(0, 0, -1, 1),
    ),
    ("%", 0.01, Dimension::ONE),
    ("min", 60.0, Dimension::new(0, 0, 1, 0)),
    ("h", 3600.0, Dimension::new(0, 0, 1, 0)),
    ("t", 1000.0, Dimension::new(0, 1, 0, 0)),
    ("gn", STANDARD_GRAVITY, Dimension::new(1, 0, -2, 0)),
    ("L", 1e-3, Dimension::new(3, 0, 0, 0)),
    ("K", 1.0, Dimension::new(0, 0, 0, 0).kelvin(1)),
    ("bar", 1e5, Dimension::new(-1, 1, -2, 0)),
];

/// Units offered when a unit is misspelt.
pub const COMMON: [&str; 30] = [
    "m", "mm", "cm", "km", "kg", "g", "t", "s", "ms", "min", "h", "N", "kN", "mN", "MN", "J", "kJ",
    "W", "kW", "Pa", "kPa", "MPa", "Hz", "kHz", "rad", "deg", "rpm", "gn", "mrad", "bar",
];

/// The unit of that name.
pub fn unit(name: &str) -> Option<Unit> {
    let find = |table: &[(&str, f64, Dimension)], name: &str| {
        table
            .iter()
            .find(|(n, ..)| *n == name)
            .map(|&(_, factor, dimension)| Unit { factor, dimension })
    };
    find(&PLAIN, name)
        .or_else(|| find(&PREFIXED, name))
        .or_else(|| {
            PREFIXES.iter().find_map(|(prefix, scale)| {
                let base = find(&PREFIXED, name.strip_prefix(prefix)?)?;
                Some(Unit {
                    factor: scale_of(base.factor, *scale),
                    ..base
                })
            })
        })
}

/// The unit that a product of units is, such as `N*m/rad`, `m/(s*s)` or `1/kg/s`; `None` if it is something else.
pub fn product(text: &str) -> Option<Unit> {
    let one = Unit {
        factor: 1.0,
        dimension: Dimension::ONE,
    };
    let mut total: Option<Unit> = None;
    let (mut rest, mut divide) = (text.trim(), false);
    loop {
        let (part, behind) = match rest.strip_prefix('(') {
            Some(inside) => {
                let (inside, behind) = inside.split_once(')')?;
                // one pair of parentheses within another is none of a unit
                let part = (!inside.contains('(')).then(|| product(inside))?;
                (part?, behind.trim_start())
            }
            None => {
                let end = rest.find(['*', '/']).unwrap_or(rest.len());
                let part = match rest[..end].trim() {
                    "1" => one,
                    part => power(part)?,
                };
                (part, &rest[end..])
            }
        };
        let so_far = total.unwrap_or(one);
        total = Some(match divide {
            true => Unit {
                factor: so_far.factor / part.factor,
                dimension: so_far.dimension / part.dimension,
            },
            false => Unit {
                factor: so_far.factor * part.factor,
                dimension: so_far.dimension * part.dimension,
            },
        });
        divide = match behind.chars().next() {
            None => return total,
            Some('*') => false,
            Some('/') => true,
            Some(_) => return None,
        };
        rest = behind[1..].trim_start();
    }
}

/// `s`, `s^2`, `s^-1`
fn power(text: &str) -> Option<Unit> {
    let Some((name, exponent)) = text.split_once('^') else {
        return unit(text);
    };
    let exponent: i32 = exponent.trim().parse().ok()?;
    let unit = unit(name.trim()).filter(|_| exponent.abs() <= 9)?;
    Some(Unit {
        factor: whole_power(unit.factor, exponent),
        dimension: unit.dimension.power(exponent),
    })
}

/// A unit as models have it, where tests and tables spell it otherwise.
pub fn spelled(said: &str) -> &str {
    match said {
        // of accelerations, not the gram
        "g" => "gn",
        "m/(s*s)" | "m/s2" | "m/s²" => "m/s^2",
        "rad/(s*s)" | "rad/s2" | "rad/s²" => "rad/s^2",
        "Nm" => "N*m",
        "kNm" => "kN*m",
        "°" => "deg",
        "°/s" => "deg/s",
        "-" => "1",
        unit => unit,
    }
}

/// A whole power by products: the square of the square and so on, and the reciprocal of that where the exponent is
/// negative.
pub fn whole_power(base: f64, exponent: i32) -> f64 {
    let (mut square, mut left, mut power) = (base, exponent.unsigned_abs(), 1.0);
    while left > 0 {
        if left & 1 == 1 {
            power *= square;
        }
        square *= square;
        left >>= 1;
    }
    if exponent < 0 { 1.0 / power } else { power }
}

/// Powers of ten multiplied without a rounding that their decimal product would not have (kg is exactly 1).
fn scale_of(factor: f64, scale: f64) -> f64 {
    whole_power(
        10.0,
        (libm::log10(factor) + libm::log10(scale)).round() as i32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_scale_by_powers_of_ten() {
        for (name, factor) in [
            ("mm", 1e-3),
            ("kg", 1.0),
            ("mg", 1e-6),
            ("kN", 1e3),
            ("MPa", 1e6),
            ("µs", 1e-6),
            ("cm", 0.01),
            ("GPa", 1e9),
            ("g", 1e-3),
        ] {
            assert_eq!(unit(name).map(|u| u.factor), Some(factor), "{name}");
        }
        assert_eq!(unit("kdeg"), None);
        assert_eq!(unit("min").map(|u| u.factor), Some(60.0));
    }

    #[test]
    fn dimensions_are_named_by_their_si_unit() {
        let of = |name: &str| unit(name).unwrap().dimension;
        assert_eq!((of("N") * of("m")).to_string(), "N*m");
        assert_eq!((of("N") * of("s") / of("m")).to_string(), "N*s/m");
        assert_eq!((of("m") / of("s").power(3)).to_string(), "m/s^3");
        assert_eq!((Dimension::ONE / of("kg")).to_string(), "1/kg");
        assert_eq!(of("deg").to_string(), "rad");
        assert_eq!(of("%").to_string(), "");
        assert_eq!(of("rad"), Dimension::ONE);
    }

    #[test]
    fn products_are_read_from_left_to_right() {
        let of = |text: &str| product(text).map(|unit| (unit.factor, unit.dimension.to_string()));
        let known = |factor: f64, si: &str| Some((factor, si.to_owned()));
        assert_eq!(of("kN*m/rad"), known(1e3, "N*m/rad"));
        assert_eq!(of("m/(s*s)"), known(1.0, "m/s^2"));
        assert_eq!(of("m / s / s"), known(1.0, "m/s^2"));
        assert_eq!(of("1/ms"), known(1e3, "1/s"));
        assert_eq!(of("mm*s^-2"), known(1e-3, "m/s^2"));
        assert_eq!(of("°/s"), known(std::f64::consts::PI / 180.0, "rad/s"));
        assert_eq!(of("1"), known(1.0, ""));
        for none in [
            "", "furlong", "5 cm", "m//s", "m/", "(m", "m)", "((m))", "m^", "m^x", "m^10", "m s",
            "2*m", "(s)m",
        ] {
            assert_eq!(of(none), None, "{none}");
        }
        for (said, si) in [
            ("g", "m/s^2"),
            ("kNm", "N*m"),
            ("rad/s²", "rad/s^2"),
            ("-", ""),
        ] {
            assert_eq!(
                product(spelled(said)).map(|unit| unit.dimension.name()),
                Some(si)
            );
        }
    }

    #[test]
    fn every_common_unit_exists() {
        assert!(COMMON.iter().all(|name| unit(name).is_some()));
    }
}
