//! The places where a dummy measures.

/// A place: its name, the channel codes of ISO-MME that belong to it, with `?` for any character and `|` between two,
/// and its SI unit.
pub struct SensorPlace {
    /// The name after `--place`; under `criteria` in a model it has `_` in place of `-`.
    pub name: &'static str,
    /// Channel codes.
    pub code: &'static str,
    /// SI unit.
    pub unit: &'static str,
}

const fn place(name: &'static str, code: &'static str, unit: &'static str) -> SensorPlace {
    SensorPlace { name, code, unit }
}

/// All places, in the order of the keys of `criteria` in a model.
pub const PLACES: [SensorPlace; 27] = [
    place("head", "??HEADCG????ACR?|??HEAD00????ACR?", "m/s^2"),
    place("head-x", "??HEADCG????ACX?|??HEAD00????ACX?", "m/s^2"),
    place("head-y", "??HEADCG????ACY?|??HEAD00????ACY?", "m/s^2"),
    place("head-z", "??HEADCG????ACZ?|??HEAD00????ACZ?", "m/s^2"),
    place("head-wx", "??HEADCG????AVX?|??HEAD00????AVX?", "rad/s"),
    place("head-wy", "??HEADCG????AVY?|??HEAD00????AVY?", "rad/s"),
    place("head-wz", "??HEADCG????AVZ?|??HEAD00????AVZ?", "rad/s"),
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
    place("knee-left", "??KNSLLE????DSX?", "m"),
    place("knee-right", "??KNSLRI????DSX?", "m"),
    place("tibia-left-mx", "??TIBILE????MOX?", "N*m"),
    place("tibia-left-my", "??TIBILE????MOY?", "N*m"),
    place("tibia-left-fz", "??TIBILE????FOZ?", "N"),
    place("tibia-right-mx", "??TIBIRI????MOX?", "N*m"),
    place("tibia-right-my", "??TIBIRI????MOY?", "N*m"),
    place("tibia-right-fz", "??TIBIRI????FOZ?", "N"),
    // a vehicle may have several accelerometers; only the user knows which one is the pulse
    place("pulse", "", "m/s^2"),
];

/// Fine locations (characters 7 to 10 of a code) that describe the place of a sensor. Others describe how a number was
/// computed, such as `3C` for a 3 ms value or `AV` for an average \[ISO/TS 13499 RED B 1.6.2, as in the program
/// pyisomme\].
const LOCATIONS: [&str; 28] = [
    "00", "CG", "CX", "CY", "CZ", "UP", "LO", "LE", "RI", "MI", "FR", "RE", "IN", "OU", "TP", "BO",
    "LU", "LL", "RU", "RL", "RD", "L1", "L2", "M1", "R1", "U1", "RW", "HS",
];

/// True if a channel code is that of a time history and matches one of the patterns. Patterns are separated by `|`, and
/// `?` stands for any character.
pub fn fits(code: &str, pattern: &str) -> bool {
    let matches = |pattern: &str| {
        let pairs = || code.chars().zip(pattern.chars());
        code.len() == pattern.len() && pairs().all(|(a, b)| b == '?' || a == b)
    };
    !code.is_empty() && pattern.split('|').any(matches) && is_time_history(code)
}

/// True if a code is that of a sensor's signal, not of a number that was computed from one.
fn is_time_history(code: &str) -> bool {
    let is_location = |at: std::ops::Range<usize>| {
        code.get(at).is_some_and(|two| {
            LOCATIONS.contains(&two) || two.bytes().all(|byte| byte.is_ascii_digit())
        })
    };
    // X marks a constant, 2 and 3 mark Nij and the combined thoracic index
    let is_signal = !code.ends_with(['X', '2', '3']);
    is_location(6..8) && is_location(8..10) && is_signal
}
