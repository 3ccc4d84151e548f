//! The construction of a body.
//!
//! - **Lengths** are those of de Leva times stature over the mean stature, **masses** shares of the mass, divided by their sum. Moments of inertia are m (r l)² of the radii of gyration.
//! - What carries what: the hip, knee, ankle, shoulder, elbow and wrist joints are the ends of the segments; abdomen, thorax and head join at navel, lower end of the breastbone and
//!   seventh neck vertebra, all on one vertical line (**assumed**: the last two lie on the front and the back).
//! - Shoulder joints are 0.170 m, hips 0.085 m from the middle at the mean stature; the ankle is 0.050 m before the heel and the foot's centre of gravity 0.040 m below the ankle (**assumed**).
//! - The sole lies where the stature ends: below the ankle by what the segments leave of it.
//! - **Ellipsoids** have the breadths, depths and girths of ANSUR II; the height of the head's, 0.13 of the stature, is **assumed**.

use super::data::{Segment, Sex, outside, segments};
use std::f64::consts::TAU;

/// How an element is joined to the one that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// The root.
    None,
    /// A ball.
    Ball,
    /// A hinge about y.
    Hinge,
    /// Hinges about y, x and z, one after the other: flexion, abduction, rotation.
    Three,
}

/// An element; of a pair the left one.
#[derive(Clone, Debug)]
pub struct Element {
    /// Name.
    pub name: &'static str,
    /// What carries it, and where \[m\].
    pub on: Option<(&'static str, [f64; 3])>,
    /// How.
    pub joint: Joint,
    /// Whether there is a right one, too.
    pub pair: bool,
    /// \[kg\]
    pub mass: f64,
    /// Centre of gravity \[m\].
    pub cg: [f64; 3],
    /// About the centre of gravity \[kg m²\].
    pub inertia: [f64; 3],
}

/// An ellipsoid of an element, by the element's name.
#[derive(Clone, Debug)]
pub struct Shape {
    /// The element.
    pub on: &'static str,
    /// \[m\]
    pub center: [f64; 3],
    /// \[m\]
    pub semi_axes: [f64; 3],
    /// Whether there is a right one, too.
    pub pair: bool,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Elements, each behind the one that carries it.
    pub elements: Vec<Element>,
    /// Ellipsoids.
    pub shapes: Vec<Shape>,
    /// Height of the hips over the sole \[m\].
    pub hip_height: f64,
    /// Height of the knees over the sole \[m\].
    pub knee_height: f64,
}

/// Half the distance of shoulder and hip joints, and places of the foot, at the mean stature \[m\].
const SHOULDER: f64 = 0.170;
const HIP: f64 = 0.085;
const HEEL: f64 = 0.050;
const FOOT: f64 = 0.040;
/// Height of the head's ellipsoid as a share of the stature.
const HEAD: f64 = 0.13;

/// A body of a stature \[m\] and a mass \[kg\].
///
/// # Errors
/// Outside of what the data can be stretched to, with the reason.
pub fn body(sex: Sex, stature: f64, mass: f64) -> Result<Body, String> {
    if !(1.40..=2.10).contains(&stature) {
        return Err(format!(
            "a stature of {stature} m is beyond the data: they are of adults, and are stretched to 1.40 to 2.10 m at most"
        ));
    }
    let index = mass / (stature * stature);
    if !(15.0..=45.0).contains(&index) {
        return Err(format!(
            "{mass} kg at {stature} m is a body mass index of {index:.1} kg/m^2, and the data are stretched to 15 to 45 at most"
        ));
    }
    let data = segments(sex);
    // metres per millimetre of the data
    let scale = stature / data.stature;
    let whole = {
        let single = data.pelvis.mass + data.abdomen.mass + data.thorax.mass + data.head.mass;
        let limbs = [
            data.upper_arm,
            data.forearm,
            data.hand,
            data.thigh,
            data.shank,
            data.foot,
        ];
        single + 2.0 * limbs.iter().map(|segment| segment.mass).sum::<f64>()
    };
    let built = Built {
        scale,
        mass: mass / whole,
    };
    let length = |segment: &Segment| segment.length * scale;
    let [pelvis, abdomen, thorax, head] =
        [&data.pelvis, &data.abdomen, &data.thorax, &data.head].map(length);
    let [upper_arm, forearm, thigh, shank] =
        [&data.upper_arm, &data.forearm, &data.thigh, &data.shank].map(length);
    let factor = 1e3 * scale;
    let shoulder = [
        0.0,
        SHOULDER * factor,
        (data.shoulder_to_hip * scale - pelvis - abdomen),
    ];
    let up = |segment: &Segment| [0.0, 0.0, (1.0 - segment.com) * length(segment)];
    let down = |segment: &Segment| [0.0, 0.0, -segment.com * length(segment)];
    let foot_cg = [
        data.foot.com * length(&data.foot) - HEEL * factor,
        0.0,
        -FOOT * factor,
    ];
    let top = |z: f64| [0.0, 0.0, z];
    let ball = |name, on, at, segment: &Segment, cg| {
        built.element((name, false), Some((on, at)), Joint::Ball, segment, cg)
    };
    let limb = |name, on, at, joint, segment: &Segment, cg| {
        built.element((name, true), Some((on, at)), joint, segment, cg)
    };
    let mut elements = vec![
        built.element(
            ("pelvis", false),
            None,
            Joint::None,
            &data.pelvis,
            up(&data.pelvis),
        ),
        ball(
            "abdomen",
            "pelvis",
            top(pelvis),
            &data.abdomen,
            up(&data.abdomen),
        ),
        ball(
            "thorax",
            "abdomen",
            top(abdomen),
            &data.thorax,
            up(&data.thorax),
        ),
        ball("head", "thorax", top(thorax), &data.head, up(&data.head)),
        limb(
            "left-upper-arm",
            "thorax",
            shoulder,
            Joint::Three,
            &data.upper_arm,
            down(&data.upper_arm),
        ),
        limb(
            "left-forearm",
            "left-upper-arm",
            top(-upper_arm),
            Joint::Hinge,
            &data.forearm,
            down(&data.forearm),
        ),
        limb(
            "left-hand",
            "left-forearm",
            top(-forearm),
            Joint::Hinge,
            &data.hand,
            down(&data.hand),
        ),
        limb(
            "left-thigh",
            "pelvis",
            [0.0, HIP * factor, 0.0],
            Joint::Three,
            &data.thigh,
            down(&data.thigh),
        ),
        limb(
            "left-shank",
            "left-thigh",
            top(-thigh),
            Joint::Hinge,
            &data.shank,
            down(&data.shank),
        ),
        limb(
            "left-foot",
            "left-shank",
            top(-shank),
            Joint::Hinge,
            &data.foot,
            foot_cg,
        ),
    ];
    if let Some(foot) = elements.last_mut() {
        // it lies: its long axis is x
        let [sagittal, transverse, longitudinal] = foot.inertia;
        foot.inertia = [longitudinal, transverse, sagittal];
    }
    let chain = pelvis + abdomen + thorax + head + thigh + shank;
    let sole = stature - chain;
    if sole <= 0.01 {
        return Err(format!(
            "segments of {chain:.3} m leave nothing of a stature of {stature} m for the feet"
        ));
    }
    let outside = outside(sex);
    let size = |name: &str| outside.of(name, stature, mass);
    let radius = |name: &str| size(name) / TAU;
    let middle = |length: f64| [0.0, 0.0, 0.5 * length];
    let round = |name: &str, length: f64| [radius(name), radius(name), 0.5 * length];
    let shape = |on, center, semi_axes, pair| Shape {
        on,
        center,
        semi_axes,
        pair,
    };
    let head_height = HEAD * stature;
    let foot_length = length(&data.foot);
    let shapes = vec![
        shape(
            "pelvis",
            middle(pelvis),
            [
                0.5 * size("buttock_depth"),
                0.5 * size("hip_breadth"),
                0.75 * pelvis,
            ],
            false,
        ),
        shape(
            "abdomen",
            middle(abdomen),
            [
                0.5 * size("waist_depth"),
                0.5 * size("waist_breadth"),
                0.75 * abdomen,
            ],
            false,
        ),
        shape(
            "thorax",
            middle(thorax),
            [
                0.5 * size("chest_depth"),
                0.5 * size("chest_breadth"),
                0.75 * thorax,
            ],
            false,
        ),
        shape(
            "head",
            [0.0, 0.0, head - 0.5 * head_height],
            [
                0.5 * size("head_length"),
                0.5 * size("head_breadth"),
                0.5 * head_height,
            ],
            false,
        ),
        shape(
            "left-upper-arm",
            middle(-upper_arm),
            round("biceps_girth", upper_arm),
            true,
        ),
        shape(
            "left-forearm",
            middle(-forearm),
            round("forearm_girth", forearm),
            true,
        ),
        shape(
            "left-thigh",
            middle(-thigh),
            round("thigh_girth", thigh),
            true,
        ),
        shape(
            "left-shank",
            middle(-shank),
            round("calf_girth", shank),
            true,
        ),
        shape(
            "left-foot",
            [0.5 * foot_length - HEEL * factor, 0.0, -0.5 * sole],
            [0.5 * foot_length, 0.5 * size("foot_breadth"), 0.5 * sole],
            true,
        ),
    ];
    if let Some(thin) = shapes
        .iter()
        .find(|shape| shape.semi_axes.iter().any(|axis| *axis < 5e-3))
    {
        return Err(format!(
            "{mass} kg at {stature} m leaves no breadth for the {}",
            thin.on
        ));
    }
    Ok(Body {
        elements,
        shapes,
        hip_height: (thigh + shank) + sole,
        knee_height: shank + sole,
    })
}

/// What all segments of a body are multiplied by.
struct Built {
    /// Lengths \[m/mm\].
    scale: f64,
    /// Shares of the mass \[kg\].
    mass: f64,
}

impl Built {
    fn element(
        &self,
        (name, pair): (&'static str, bool),
        on: Option<(&'static str, [f64; 3])>,
        joint: Joint,
        segment: &Segment,
        cg: [f64; 3],
    ) -> Element {
        let mass = self.mass * segment.mass;
        let length = self.scale * segment.length;
        Element {
            name,
            on,
            joint,
            pair,
            mass,
            cg,
            inertia: segment.radii.map(|radius| mass * (radius * length).powi(2)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Body, body};
    use crate::human::Sex;

    fn mass(body: &Body) -> f64 {
        let of = |element: &super::Element| element.mass * if element.pair { 2.0 } else { 1.0 };
        body.elements.iter().map(of).sum()
    }

    /// A man of 77.7 kg and 1.753 m and a woman of 49 kg and 1.501 m, as somebody else derived them from the same table, printed to four decimals (six of moments).
    #[test]
    fn bodies_are_those_of_an_independent_derivation() {
        let man = [
            (
                "pelvis",
                8.6791,
                [0.0, 0.0, 0.0570],
                [0.070650, 0.056710, 0.064363],
            ),
            (
                "thorax",
                12.4009,
                [0.0, 0.0, 0.1203],
                [0.187928, 0.075459, 0.159337],
            ),
            (
                "head",
                5.3924,
                [0.0, 0.0, 0.1222],
                [0.029613, 0.032005, 0.021973],
            ),
            (
                "left-upper-arm",
                2.1057,
                [0.0, 0.0, -0.1637],
                [0.013760, 0.012258, 0.004229],
            ),
            (
                "left-hand",
                0.4740,
                [0.0, 0.0, -0.0686],
                [0.001407, 0.000937, 0.000574],
            ),
            (
                "left-thigh",
                11.0023,
                [0.0, 0.0, -0.1741],
                [0.215218, 0.215218, 0.044143],
            ),
            (
                "left-shank",
                3.3644,
                [0.0, 0.0, -0.1948],
                [0.041660, 0.040017, 0.006880],
            ),
            (
                "left-foot",
                1.0645,
                [0.0644, 0.0, -0.0403],
                [0.001105, 0.004315, 0.004748],
            ),
        ];
        let woman = [
            (
                "abdomen",
                7.1785,
                [0.0, 0.0, 0.0975],
                [0.042457, 0.028378, 0.039001],
            ),
            (
                "left-forearm",
                0.6762,
                [0.0, 0.0, -0.1042],
                [0.002408, 0.002335, 0.000312],
            ),
            (
                "left-foot",
                0.6321,
                [0.0360, 0.0, -0.0346],
                [0.000476, 0.001919, 0.002204],
            ),
        ];
        let check = |sex, stature, total, expected: &[(&str, f64, [f64; 3], [f64; 3])]| {
            let body = body(sex, stature, total).unwrap();
            for (name, mass, cg, inertia) in expected {
                let element = body.elements.iter().find(|one| one.name == *name).unwrap();
                // the shares of the women sum to 0.9999, and are divided by that here
                assert!(
                    (element.mass - mass).abs() < 6e-5 + 2e-4 * mass,
                    "{name} {}",
                    element.mass
                );
                for i in 0..3 {
                    assert!(
                        (element.cg[i] - cg[i]).abs() < 6e-5,
                        "{name} {:?}",
                        element.cg
                    );
                    assert!(
                        (element.inertia[i] - inertia[i]).abs() < 6e-7 + 2e-4 * inertia[i],
                        "{name} {:?}",
                        element.inertia
                    );
                }
            }
        };
        check(Sex::Male, 1.753, 77.7, &man);
        check(Sex::Female, 1.501, 49.0, &woman);
    }

    #[test]
    fn masses_and_lengths_add_up_for_all_sizes() {
        for sex in [Sex::Female, Sex::Male] {
            for stature in [1.40, 1.55, 1.70, 1.85, 2.10] {
                for index in [15.1, 18.0, 25.0, 35.0, 44.9] {
                    let total = index * stature * stature;
                    let body = body(sex, stature, total).unwrap();
                    assert!((mass(&body) - total).abs() < 1e-9 * total);
                    let part =
                        |name: &str| body.elements.iter().find(|one| one.name == name).unwrap();
                    let at = |name: &str| part(name).on.unwrap().1[2];
                    // sole to hip, up the spine, and the head's length above the thorax
                    let head = body.shapes.iter().find(|shape| shape.on == "head").unwrap();
                    let top = body.hip_height
                        + at("abdomen")
                        + at("thorax")
                        + at("head")
                        + head.center[2]
                        + head.semi_axes[2];
                    assert!((top - stature).abs() < 1e-12, "{top}");
                    for element in &body.elements {
                        let [a, b, c] = element.inertia;
                        assert!(
                            a > 0.0 && b > 0.0 && c > 0.0 && a < b + c && b < a + c && c < a + b,
                            "{element:?}"
                        );
                    }
                }
            }
        }
        for (stature, mass) in [
            (1.2, 40.0),
            (1.75, 40.0),
            (1.75, 150.0),
            (f64::NAN, 70.0),
            (1.7, f64::NAN),
        ] {
            assert!(body(Sex::Male, stature, mass).is_err(), "{stature} {mass}");
        }
    }
}
