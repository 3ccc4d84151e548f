//! Bodies with the masses of crash dummies, and of children with the dimensions of child dummies.
//!
//! - An **adult dummy** is an adult of the dummy's stature whose parts have the dummy's masses. The mass of a part is
//!   divided among its segments in de Leva's proportions.
//! - A **child** has the lengths of a child dummy. Its limbs are uniform cylinders of 1000 kg/m³. Its trunk is a
//!   uniform elliptical cylinder, cut into pelvis, abdomen and thorax where de Leva cuts that of a man. Its head is a
//!   uniform ellipsoid on a uniform cylinder, the neck.
//!
//! `dummies.json` and docs/humans.md say what is published and what is assumed.

use super::data::{Outside, Segment, Segments, Sex, read, segments};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Density of limbs \[kg/mm³\].
const DENSITY: f64 = 1e-6;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Dummies {
    #[serde(rename = "source")]
    _source: String,
    child: BTreeMap<String, Child>,
    adult: BTreeMap<String, Adult>,
}

/// Lengths \[mm\] and masses \[kg\] of a child dummy.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Child {
    source: String,
    stature: f64,
    vertex_above_hip: f64,
    /// Length from the hips to the base of the neck.
    trunk: f64,
    neck: f64,
    neck_radius: f64,
    shoulder_to_hip: f64,
    upper_arm: f64,
    forearm: f64,
    hand: f64,
    thigh: f64,
    shank: f64,
    foot: f64,
    half_shoulders: f64,
    half_hips: f64,
    heel: f64,
    foot_below_ankle: f64,
    /// Length, breadth and height.
    head: [f64; 3],
    trunk_depth: f64,
    trunk_breadth: f64,
    hip_breadth: f64,
    foot_breadth: f64,
    masses: ChildMasses,
}

/// Masses \[kg\]; for a pair, the mass of one of the two.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ChildMasses {
    head: f64,
    neck: f64,
    trunk: f64,
    upper_arm: f64,
    forearm_and_hand: f64,
    thigh: f64,
    shank: f64,
    foot: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Adult {
    source: String,
    sex: String,
    stature: f64,
    masses: AdultMasses,
}

/// Masses \[kg\]; for a pair, the mass of one of the two.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AdultMasses {
    head: f64,
    neck: f64,
    upper_torso: f64,
    lower_torso: f64,
    upper_arm: f64,
    forearm_and_hand: f64,
    thigh: f64,
    shank_and_foot: f64,
}

/// The data of the body of a dummy.
pub struct Made {
    /// Its segments; their masses are in kg.
    pub segments: Segments,
    /// The outer dimensions; `None` stands for those of an adult of this sex.
    pub outside: Option<Outside>,
    /// The sex whose data are used.
    pub sex: Sex,
    /// Stature \[m\].
    pub stature: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Mass of its neck \[kg\].
    pub neck: f64,
    /// The source of its numbers.
    pub source: String,
}

/// The dummy with this name; `None` if there is none.
pub fn dummy(name: &str) -> Option<Made> {
    let mut dummies: Dummies = read(include_str!("dummies.json"));
    if let Some(child) = dummies.child.remove(name) {
        return Some(child.made());
    }
    dummies.adult.remove(name).map(Adult::made)
}

impl Adult {
    fn made(self) -> Made {
        let (sex, masses) = (
            match self.sex.as_str() {
                "female" => Sex::Female,
                _ => Sex::Male,
            },
            self.masses,
        );
        let mut of = segments(sex);
        let share = |mass: f64, parts: &mut [&mut Segment]| {
            let whole: f64 = parts.iter().map(|part| part.mass).sum();
            for part in parts {
                part.mass *= mass / whole;
            }
        };
        share(masses.head + masses.neck, &mut [&mut of.head]);
        share(masses.upper_torso, &mut [&mut of.thorax]);
        share(masses.lower_torso, &mut [&mut of.abdomen, &mut of.pelvis]);
        share(masses.upper_arm, &mut [&mut of.upper_arm]);
        share(
            masses.forearm_and_hand,
            &mut [&mut of.forearm, &mut of.hand],
        );
        share(masses.thigh, &mut [&mut of.thigh]);
        share(masses.shank_and_foot, &mut [&mut of.shank, &mut of.foot]);
        Made {
            mass: of.mass(),
            segments: of,
            outside: None,
            sex,
            stature: 1e-3 * self.stature,
            neck: masses.neck,
            source: self.source,
        }
    }
}

/// Radius of a limb as a cylinder of this mass and length \[mm\].
fn radius(mass: f64, length: f64) -> f64 {
    (mass / (DENSITY * PI * length)).sqrt()
}

/// A uniform elliptical cylinder of depth `a` and breadth `b`, about its middle.
fn cylinder(mass: f64, length: f64, [a, b]: [f64; 2]) -> Segment {
    let [a, b] = [a, b].map(|width| {
        let share = 0.5 * width / length;
        share * share / 4.0
    });
    let lengthwise = 1.0 / 12.0;
    Segment {
        mass,
        length,
        com: 0.5,
        radii: [b + lengthwise, a + lengthwise, a + b].map(f64::sqrt),
    }
}

fn limb(mass: f64, length: f64) -> Segment {
    cylinder(mass, length, [2.0 * radius(mass, length); 2])
}

impl Child {
    /// Head and neck as one segment, from the base of the neck to the vertex.
    fn head_and_neck(&self) -> Segment {
        let length = self.vertex_above_hip - self.trunk;
        let [head, neck] = [self.masses.head, self.masses.neck];
        let semi = self.head.map(|axis| 0.5 * axis);
        let centers = [length - semi[2], 0.5 * self.neck];
        let mass = head + neck;
        let center = (head * centers[0] + neck * centers[1]) / mass;
        let of_neck = cylinder(neck, self.neck, [2.0 * self.neck_radius; 2]);
        let of_head = [[semi[1], semi[2]], [semi[0], semi[2]], [semi[0], semi[1]]]
            .map(|[a, b]| (a * a + b * b) / 5.0);
        let apart = [centers[0] - center, centers[1] - center].map(|distance| distance * distance);
        let radii = [0, 1, 2].map(|axis| {
            let [of_head_apart, of_neck_apart] = if axis == 2 { [0.0; 2] } else { apart };
            let radius = of_neck.radii[axis] * self.neck;
            let of_neck = radius * radius;
            let square = head * (of_head[axis] + of_head_apart) + neck * (of_neck + of_neck_apart);
            (square / mass).sqrt() / length
        });
        Segment {
            mass,
            length,
            com: 1.0 - center / length,
            radii,
        }
    }

    fn made(self) -> Made {
        let man = segments(Sex::Male);
        let parts = [&man.pelvis, &man.abdomen, &man.thorax];
        let length: f64 = parts.iter().map(|part| part.length).sum();
        let shares = parts.map(|part| part.length / length);
        let trunk = |share: f64| {
            let width = [self.trunk_depth, self.trunk_breadth];
            cylinder(share * self.masses.trunk, share * self.trunk, width)
        };
        let arm = self.masses.forearm_and_hand;
        let hand = man.hand.mass / (man.hand.mass + man.forearm.mass);
        let segments = Segments {
            stature: self.stature,
            pelvis: trunk(shares[0]),
            abdomen: trunk(shares[1]),
            thorax: trunk(shares[2]),
            head: self.head_and_neck(),
            upper_arm: limb(self.masses.upper_arm, self.upper_arm),
            forearm: limb((1.0 - hand) * arm, self.forearm),
            hand: limb(hand * arm, self.hand),
            thigh: limb(self.masses.thigh, self.thigh),
            shank: limb(self.masses.shank, self.shank),
            foot: limb(self.masses.foot, self.foot),
            shoulder_to_hip: self.shoulder_to_hip,
            half_shoulders: self.half_shoulders,
            half_hips: self.half_hips,
            heel: self.heel,
            foot_below_ankle: self.foot_below_ankle,
            head_height: self.head[2] / self.stature,
        };
        let girth = |segment: &Segment| TAU * radius(segment.mass, segment.length);
        let outside = [
            ("head_length", self.head[0]),
            ("head_breadth", self.head[1]),
            ("chest_depth", self.trunk_depth),
            ("chest_breadth", self.trunk_breadth),
            ("waist_depth", self.trunk_depth),
            ("waist_breadth", self.hip_breadth),
            ("buttock_depth", self.trunk_depth),
            ("hip_breadth", self.hip_breadth),
            ("biceps_girth", girth(&segments.upper_arm)),
            ("forearm_girth", girth(&segments.forearm)),
            ("thigh_girth", girth(&segments.thigh)),
            ("calf_girth", girth(&segments.shank)),
            ("foot_breadth", self.foot_breadth),
        ];
        Made {
            mass: segments.mass(),
            outside: Some(Outside::fixed(outside)),
            sex: Sex::Male,
            stature: 1e-3 * self.stature,
            neck: self.masses.neck,
            segments,
            source: self.source,
        }
    }
}
