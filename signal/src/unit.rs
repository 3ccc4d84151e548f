//! Units of channels in the spellings of tables and of files of test data.

use bryant_table::unit::{Dimension, Unit, product, spelled};

/// The SI units of what is measured in tests. Behind other names, a letter between brackets may be a side or a number.
const MEASURED: [&str; 10] = [
    "m/s^2", "N", "N*m", "m", "m/s", "rad", "rad/s", "rad/s^2", "s", "Pa",
];

fn known(unit: &str) -> Option<Unit> {
    product(spelled(unit))
}

/// The SI unit of the quantity that a unit measures, "" for a pure number; `None` for an unknown unit.
pub fn quantity(unit: &str) -> Option<&'static str> {
    let dimension = known(unit)?.dimension;
    match dimension.name() {
        "" => (dimension == Dimension::ONE).then_some(""),
        si => MEASURED.contains(&si).then_some(si),
    }
}

/// The factor that converts numbers from one unit to another; `None` if the quantities differ, or if a unit is unknown
/// and the two spellings differ. A missing unit fits only a missing unit.
pub fn factor(from: &str, to: &str) -> Option<f64> {
    if from == to {
        return Some(1.0);
    }
    let (from, to) = (known(from)?, known(to)?);
    let of_angles = |unit: &Unit| unit.dimension.radians();
    let same = from.dimension == to.dimension && of_angles(&from) == of_angles(&to);
    same.then(|| from.factor / to.factor)
}

#[cfg(test)]
mod tests {
    use super::{factor, quantity};

    #[test]
    fn units_of_one_quantity_have_a_factor() {
        assert_eq!(factor("g", "m/(s*s)"), Some(9.80665));
        assert_eq!(factor("kN", "N"), Some(1e3));
        assert_eq!(factor("°/s", "rad/s"), factor("deg", "rad"));
        assert_eq!(factor("km/h", "m/s"), Some(1.0 / 3.6));
        assert_eq!(factor("furlong", "furlong"), Some(1.0));
        assert_eq!(factor("N", "N*m"), None);
        assert_eq!(factor("rad", "-"), None);
        assert_eq!(factor("", "N"), None);
    }

    #[test]
    fn quantities_are_those_of_tests() {
        assert_eq!(quantity("kNm"), Some("N*m"));
        assert_eq!(quantity("-"), Some(""));
        // a litre, a left side
        assert_eq!(quantity("L"), None);
        assert_eq!(quantity("m^3/kg"), None);
    }
}
