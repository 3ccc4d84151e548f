//! What is known of people.

use serde::Deserialize;
use std::collections::BTreeMap;

/// The sex that the data are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sex {
    /// Female.
    Female,
    /// Male.
    Male,
}

/// A segment, as a share of the body and of its own length.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// As a share of the body's.
    pub mass: f64,
    /// \[mm\] at the mean stature.
    pub length: f64,
    /// From the upper end, of a foot from the heel, as a share of the length.
    pub com: f64,
    /// About the sagittal, transverse, longitudinal axis, as shares of the length.
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
    /// From midway between the shoulder joints to midway between the hips \[mm\].
    pub shoulder_to_hip: f64,
    /// Half the distance of the shoulder joints \[mm\].
    pub half_shoulders: f64,
    /// Half the distance of the hips \[mm\].
    pub half_hips: f64,
    /// From the heel forward to the ankle \[mm\].
    pub heel: f64,
    /// From the ankle down to the foot's centre of gravity \[mm\].
    pub foot_below_ankle: f64,
    /// Height of the head's ellipsoid as a share of the stature.
    pub head_height: f64,
}

impl Segments {
    /// The mass of all together, in what masses are given in.
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

/// Outer dimensions of one sex: a, b \[mm/mm\], c \[mm/kg\] of a + b stature + c mass.
pub struct Outside(BTreeMap<String, [f64; 3]>);

impl Outside {
    /// Of these dimensions \[mm\], by name, whatever the size.
    pub fn fixed(dimensions: impl IntoIterator<Item = (&'static str, f64)>) -> Self {
        let dimensions = dimensions.into_iter();
        Outside(
            dimensions
                .map(|(name, a)| (name.to_owned(), [a, 0.0, 0.0]))
                .collect(),
        )
    }

    /// A dimension \[m\] of a stature \[m\] and a mass \[kg\].
    ///
    /// # Panics
    /// There is no such dimension.
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

/// Data that this crate carries.
pub fn read<T: serde::de::DeserializeOwned>(text: &str) -> T {
    serde_yaml::from_str(text).unwrap_or_else(|error| unreachable!("bundled data: {error}"))
}
