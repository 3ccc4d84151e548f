//! Limits by regulation and dummy, with their sources: `limits.json`.

use super::Criterion;
use bryant_runtime::response::FallingLimit;
use bryant_runtime::response::channel::{Chest, Neck};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

/// A limit, in the unit in which its criterion is shown.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Limit {
    /// One number.
    Constant(f64),
    /// Corners, each a duration \[ms\] and a level: the limit of a load that falls with the time for which a level of
    /// the load is exceeded in total.
    Falling(Vec<[f64; 2]>),
}

impl Limit {
    /// The limit in SI, if it falls with the duration of the load; `scale` is the SI value of its unit.
    pub fn falling(&self, scale: f64) -> Option<FallingLimit> {
        let Limit::Falling(corners) = self else {
            return None;
        };
        let corners = corners.iter().map(|[ms, level]| [ms / 1e3, level * scale]);
        FallingLimit::new(&corners.collect::<Vec<_>>())
    }

    /// The limit in words: "4170 N", or "3300 N at 0 ms, 2900 N at 35 ms".
    pub fn text(&self, unit: &str) -> String {
        let with_unit = |level: &f64| format!("{level} {unit}").trim_end().to_owned();
        match self {
            Limit::Constant(limit) => with_unit(limit),
            Limit::Falling(corners) => {
                let each = corners.iter();
                let each = each.map(|[ms, level]| format!("{} at {ms} ms", with_unit(level)));
                each.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

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
    pub limits: BTreeMap<String, Limit>,
    /// Critical values of the neck; `None` if there is no such criterion.
    #[serde(default, deserialize_with = "neck")]
    pub nij: Option<Neck>,
    /// The dimensions of the chest for the viscous criterion; `None` if there is no such criterion.
    #[serde(default, deserialize_with = "chest")]
    pub chest: Option<Chest>,
    /// Critical moment \[N m\] and force \[N\] of the tibia; `None` if there is no such criterion.
    pub tibia: Option<[f64; 2]>,
}

impl Limits {
    /// The limit of a criterion; `None` if there is none.
    pub fn of(&self, criterion: &Criterion) -> Option<&Limit> {
        self.limits.get(criterion.name)
    }

    /// The limit of a criterion in SI, if it falls with the duration of the load.
    pub fn falling(&self, criterion: &Criterion) -> Option<FallingLimit> {
        self.of(criterion)?.falling(criterion.scale)
    }
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
