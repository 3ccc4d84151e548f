//! Limits by regulation and dummy, with their sources: `limits.json`.

use bryant_runtime::response::channel::{Chest, Neck};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

/// The limits of a regulation for a dummy.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// The regulation.
    pub standard: String,
    /// The dummy.
    pub dummy: String,
    /// The source of the numbers.
    pub source: String,
    /// The code of the dummy, characters 11 and 12 of channel codes; `None` if it is not known.
    pub code: Option<String>,
    /// Filter classes by criterion where they differ from those of SAE J211-1.
    #[serde(default)]
    pub filters: BTreeMap<String, u16>,
    /// Limits by criterion, in the unit in which the criterion is shown.
    pub limits: BTreeMap<String, f64>,
    /// Critical values of the neck; `None` if there is no such criterion.
    #[serde(default, deserialize_with = "neck")]
    pub nij: Option<Neck>,
    /// The dimensions of the chest for the viscous criterion; `None` if there is no such criterion.
    #[serde(default, deserialize_with = "chest")]
    pub chest: Option<Chest>,
    /// Critical moment \[N m\] and force \[N\] of the tibia; `None` if there is no such criterion.
    pub tibia: Option<[f64; 2]>,
}

/// The critical values of the neck as `limits.json` has them.
#[derive(Deserialize)]
#[serde(remote = "Neck", deny_unknown_fields)]
struct WrittenNeck {
    tension: f64,
    compression: f64,
    flexion: f64,
    extension: f64,
}

/// The dimensions of the chest as `limits.json` has them.
#[derive(Deserialize)]
#[serde(remote = "Chest", deny_unknown_fields)]
struct WrittenChest {
    factor: f64,
    depth: f64,
}

fn neck<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Neck>, D::Error> {
    #[derive(Deserialize)]
    struct Read(#[serde(with = "WrittenNeck")] Neck);
    Ok(Option::<Read>::deserialize(from)?.map(|read| read.0))
}

fn chest<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Chest>, D::Error> {
    #[derive(Deserialize)]
    struct Read(#[serde(with = "WrittenChest")] Chest);
    Ok(Option::<Read>::deserialize(from)?.map(|read| read.0))
}

/// The limits of all regulations.
///
/// # Panics
/// Never: a test reads `limits.json`.
pub fn all() -> Vec<Limits> {
    let read = serde_json::from_str(include_str!("limits.json"));
    read.unwrap_or_else(|error| unreachable!("limits.json: {error}"))
}

/// The limits of a regulation for a dummy; the names may be in upper or lower case.
///
/// # Errors
/// There are no such limits.
pub fn find(standard: &str, dummy: &str) -> Result<Limits, String> {
    let all = all();
    let fits = |one: &&Limits| {
        one.standard.eq_ignore_ascii_case(standard.trim())
            && one.dummy.eq_ignore_ascii_case(dummy.trim())
    };
    all.iter().find(fits).cloned().ok_or_else(|| {
        let known = all
            .iter()
            .map(|one| format!("{}, {}", one.standard, one.dummy));
        format!(
            "there are no limits of \"{standard}\" for \"{dummy}\"\n  help: there are those of {}",
            known.collect::<Vec<_>>().join("; ")
        )
    })
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
            for (name, class) in &limits.filters {
                let criterion = CRITERIA.iter().find(|one| one.name == name).unwrap();
                let found = criterion.class(limits).unwrap();
                assert_eq!(found.number(), *class, "{name}");
                assert!(limits.limits.contains_key(name), "{name}");
            }
            // criteria that need additional values have them
            assert_eq!(limits.limits.contains_key("Nij"), limits.nij.is_some());
            assert_eq!(limits.limits.contains_key("VC"), limits.chest.is_some());
            let of_tibia = limits.limits.contains_key("tibia left");
            assert_eq!(of_tibia, limits.tibia.is_some());
        }
    }
}
