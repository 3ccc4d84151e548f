//! Anthropometric data.

use serde::Deserialize;
use std::collections::BTreeMap;

/// The sex of the persons in the data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sex {
    /// Female.
    Female,
    /// Male.
    Male,
}

/// A segment, relative to the body and to its own length.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// Its mass as a share of the mass of the body.
    pub mass: f64,
    /// Its length at the mean stature \[mm\].
    pub length: f64,
    /// The centre of gravity from the upper end, for a foot from the heel, as a share of the length.
    pub com: f64,
    /// Radii of gyration about the sagittal, transverse and longitudinal axis, as shares of the length.
    pub radii: [f64; 3],
}

/// All segments of one sex.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segments {
    /// The mean stature \[mm\].
    pub stature: f64,
    pub pelvis: Segment,
    pub abdomen: Segment,
    pub thorax: Segment,
    pub head: Segment,
    pub upper_arm: Segment,
    pub forearm: Segment,
    pub hand: Segment,
    pub thigh: Segment,
    pub shank: Segment,
    pub foot: Segment,
    /// Distance from the middle between the shoulder joints to the middle between the hips \[mm\].
    pub shoulder_to_hip: f64,
    /// Half the distance of the shoulder joints \[mm\].
    pub half_shoulders: f64,
    /// Half the distance of the hips \[mm\].
    pub half_hips: f64,
    /// Distance from the heel forward to the ankle \[mm\].
    pub heel: f64,
    /// Distance from the ankle down to the centre of gravity of the foot \[mm\].
    pub foot_below_ankle: f64,
    /// Height of the head's ellipsoid as a share of the stature.
    pub head_height: f64,
}

impl Segments {
    /// The sum of the masses of all segments, in the unit of the data.
    pub fn mass(&self) -> f64 {
        let single = [&self.pelvis, &self.abdomen, &self.thorax, &self.head];
        let pairs = [
            &self.upper_arm,
            &self.forearm,
            &self.hand,
            &self.thigh,
            &self.shank,
            &self.foot,
        ];
        let single: f64 = single.iter().map(|segment| segment.mass).sum();
        let pairs: f64 = pairs.iter().map(|segment| 2.0 * segment.mass).sum();
        single + pairs
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BothSegments {
    #[serde(rename = "source")]
    _source: String,
    male: Segments,
    female: Segments,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BothOutside {
    #[serde(rename = "source")]
    _source: String,
    male: BTreeMap<String, [f64; 3]>,
    female: BTreeMap<String, [f64; 3]>,
}

/// Outer dimensions of one sex: a, b \[mm/mm\] and c \[mm/kg\] of a + b stature + c mass.
pub struct Outside(BTreeMap<String, [f64; 3]>);

impl Outside {
    /// Fixed dimensions \[mm\], by name, whatever the size of the person.
    pub fn fixed(dimensions: impl IntoIterator<Item = (&'static str, f64)>) -> Self {
        let dimensions = dimensions.into_iter();
        Outside(
            dimensions
                .map(|(name, a)| (name.to_owned(), [a, 0.0, 0.0]))
                .collect(),
        )
    }

    /// A dimension \[m\] for a stature \[m\] and a mass \[kg\].
    ///
    /// # Panics
    /// If there is no dimension with this name.
    pub fn of(&self, name: &str, stature: f64, mass: f64) -> f64 {
        let [a, b, c] = self.0[name];
        1e-3 * (a + b * 1e3 * stature + c * mass)
    }
}

/// The segments of a sex.
pub fn segments(sex: Sex) -> Segments {
    let both: BothSegments = read(include_str!("segments.json"));
    match sex {
        Sex::Female => both.female,
        Sex::Male => both.male,
    }
}

/// The outer dimensions of a sex.
pub fn outside(sex: Sex) -> Outside {
    let both: BothOutside = read(include_str!("outside.json"));
    Outside(match sex {
        Sex::Female => both.female,
        Sex::Male => both.male,
    })
}

/// Reads data that is included in this crate.
pub fn read<T: serde::de::DeserializeOwned>(text: &str) -> T {
    serde_yaml::from_str(text).unwrap_or_else(|error| unreachable!("bundled data: {error}"))
}
