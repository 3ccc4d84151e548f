//! Units of channels in the spellings of tables and of files of test data.

/// A quantity, named by the first spelling of its SI unit.
type Quantity = &'static str;

/// Spellings of a unit, its quantity, and the SI value of the unit.
const KNOWN: &[(&str, Quantity, f64)] = &[
    ("m/s^2", "m/s^2", 1.0),
    ("m/(s*s)", "m/s^2", 1.0),
    ("m/s2", "m/s^2", 1.0),
    ("m/s²", "m/s^2", 1.0),
    ("g", "m/s^2", 9.80665),
    ("gn", "m/s^2", 9.80665),
    ("N", "N", 1.0),
    ("kN", "N", 1e3),
    ("N*m", "N*m", 1.0),
    ("Nm", "N*m", 1.0),
    ("kN*m", "N*m", 1e3),
    ("kNm", "N*m", 1e3),
    ("m", "m", 1.0),
    ("mm", "m", 1e-3),
    ("cm", "m", 1e-2),
    ("m/s", "m/s", 1.0),
    ("km/h", "m/s", 1.0 / 3.6),
    ("rad", "rad", 1.0),
    ("deg", "rad", std::f64::consts::PI / 180.0),
    ("°", "rad", std::f64::consts::PI / 180.0),
    ("rad/s", "rad/s", 1.0),
    ("deg/s", "rad/s", std::f64::consts::PI / 180.0),
    ("°/s", "rad/s", std::f64::consts::PI / 180.0),
    ("rad/s^2", "rad/s^2", 1.0),
    ("rad/(s*s)", "rad/s^2", 1.0),
    ("s", "s", 1.0),
    ("ms", "s", 1e-3),
    ("us", "s", 1e-6),
    ("µs", "s", 1e-6),
    ("min", "s", 60.0),
    ("Pa", "Pa", 1.0),
    ("kPa", "Pa", 1e3),
    ("MPa", "Pa", 1e6),
    ("bar", "Pa", 1e5),
    ("1", "1", 1.0),
    ("-", "1", 1.0),
];

/// The SI unit of the quantity of a unit; `None` for an unknown unit.
pub fn quantity(unit: &str) -> Option<&'static str> {
    let known = KNOWN.iter().find(|known| known.0 == unit);
    known.map(|known| known.1)
}

/// The factor that converts numbers from one unit to another; `None` if the quantities differ, or if a unit is unknown
/// and the two spellings differ. A missing unit fits only a missing unit.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(1.0);
    }
    let known = |unit: &str| KNOWN.iter().find(|known| known.0 == unit);
    let (from, to) = (known(from)?, known(to)?);
    (from.1 == to.1).then(|| from.2 / to.2)
}

#[cfg(test)]
mod tests {
    use super::factor;

    #[test]
    fn units_of_one_quantity_have_a_factor() {
        assert_eq!(factor("g", "m/(s*s)"), Some(9.80665));
        assert_eq!(factor("kN", "N"), Some(1e3));
        assert_eq!(factor("furlong", "furlong"), Some(1.0));
        assert_eq!(factor("N", "N*m"), None);
        assert_eq!(factor("", "N"), None);
    }
}
