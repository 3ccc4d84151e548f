//! The places where a dummy measures.

/// A place: its name, the channel code of ISO-MME that belongs to it, with `?` for any character, and its SI unit.
pub struct Place {
    /// The name after `--place`; under `criteria` in a model it has `_` in place of `-`.
    pub name: &'static str,
    /// Channel code.
    pub code: &'static str,
    /// SI unit.
    pub unit: &'static str,
}

const fn place(name: &'static str, code: &'static str, unit: &'static str) -> Place {
    Place { name, code, unit }
}

/// All places, in the order of the keys of `criteria` in a model.
pub const PLACES: [Place; 25] = [
    place("head", "??HEADCG????ACR?", "m/s^2"),
    place("head-x", "??HEADCG????ACX?", "m/s^2"),
    place("head-y", "??HEADCG????ACY?", "m/s^2"),
    place("head-z", "??HEADCG????ACZ?", "m/s^2"),
    place("head-wx", "??HEADCG????AVX?", "rad/s"),
    place("head-wy", "??HEADCG????AVY?", "rad/s"),
    place("head-wz", "??HEADCG????AVZ?", "rad/s"),
    // there is no single code for excursions
    place("head-excursion", "", "m"),
    place("neck-fx", "??NECKUP????FOX?", "N"),
    place("neck-fz", "??NECKUP????FOZ?", "N"),
    place("neck-my", "??NECKUP????MOY?", "N*m"),
    place("chest", "??CHST??????ACR?", "m/s^2"),
    place("chest-x", "??CHST??????ACX?", "m/s^2"),
    place("chest-y", "??CHST??????ACY?", "m/s^2"),
    place("chest-z", "??CHST??????ACZ?", "m/s^2"),
    place("chest-deflection", "??CHST??????DSX?", "m"),
    place("femur-left", "??FEMRLE????FOZ?", "N"),
    place("femur-right", "??FEMRRI????FOZ?", "N"),
    place("tibia-left-mx", "??TIBILE????MOX?", "N*m"),
    place("tibia-left-my", "??TIBILE????MOY?", "N*m"),
    place("tibia-left-fz", "??TIBILE????FOZ?", "N"),
    place("tibia-right-mx", "??TIBIRI????MOX?", "N*m"),
    place("tibia-right-my", "??TIBIRI????MOY?", "N*m"),
    place("tibia-right-fz", "??TIBIRI????FOZ?", "N"),
    // only the user knows which accelerometer of a vehicle is meant
    place("pulse", "", "m/s^2"),
];

/// Whether a channel code matches a pattern with wild cards.
pub fn fits(code: &str, pattern: &str) -> bool {
    let pairs = || code.chars().zip(pattern.chars());
    !code.is_empty() && code.len() == pattern.len() && pairs().all(|(a, b)| b == '?' || a == b)
}

#[cfg(test)]
mod tests {
    use super::{PLACES, fits};
    use crate::facts::ModelFacts;
    use bryant_generator::description::vocabulary;

    /// The keys of `criteria` in a model are the places, in the same order.
    #[test]
    fn a_model_has_all_places_as_keys() {
        let all = vocabulary();
        let (_, keys) = all
            .iter()
            .find(|(title, _)| *title == "a set of criteria")
            .unwrap();
        // a head is three places of the neck
        let keys = keys.iter().filter(|key| key.name != "neck");
        let keys = keys.map(|key| key.name.replace('_', "-"));
        let places = PLACES.iter().map(|place| place.name.to_owned());
        let others = ["standard", "dummy", "filter-standard"].map(str::to_owned);
        assert!(keys.eq(others.into_iter().chain(places)));
        assert!(ModelFacts::default().criteria.is_none());
    }

    #[test]
    fn codes_fit_with_wild_cards() {
        assert!(fits("11HEADCG00H3ACXA", PLACES[1].code));
        assert!(!fits("11HEADCG00H3ACXA", PLACES[2].code));
        assert!(!fits("", ""));
    }
}
