//! Limits by regulation and dummy, with their sources: `limits.json`.

use serde::Deserialize;
use std::collections::BTreeMap;

/// What a regulation wants of a dummy.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// Where the numbers are from.
    pub source: String,
    /// By criterion, in the unit that it is shown in.
    pub limits: BTreeMap<String, f64>,
    /// Critical values of the neck; none where there is no such criterion.
    pub nij: Option<Neck>,
    /// The chest for the viscous criterion; none where there is no such criterion.
    pub chest: Option<Chest>,
}

/// Critical values of Nij.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Neck {
    /// \[N\]
    pub tension: f64,
    /// \[N\]
    pub compression: f64,
    /// \[N m\]
    pub flexion: f64,
    /// \[N m\]
    pub extension: f64,
}

/// What the viscous criterion needs.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chest {
    /// Scaling factor of the dummy \[1\].
    pub factor: f64,
    /// Depth of its chest \[m\].
    pub depth: f64,
}

/// All of them.
///
/// # Panics
/// Never: a test reads the file.
pub fn all() -> Vec<Limits> {
    let read = serde_json::from_str(include_str!("limits.json"));
    read.unwrap_or_else(|error| unreachable!("limits.json: {error}"))
}

#[cfg(test)]
mod tests {
    use super::super::CRITERIA;
    use super::all;

    #[test]
    fn every_limit_is_of_a_criterion_and_positive() {
        let all = all();
        assert!(all.len() >= 6);
        for limits in &all {
            for (name, limit) in &limits.limits {
                assert!(CRITERIA.iter().any(|one| one.name == name), "{name}");
                assert!(*limit > 0.0, "{name}");
            }
            // what a criterion needs besides is there
            assert_eq!(limits.limits.contains_key("Nij"), limits.nij.is_some());
            assert_eq!(limits.limits.contains_key("VC"), limits.chest.is_some());
        }
    }
}
