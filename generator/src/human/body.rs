//! The construction of a body.
//!
//! - **Lengths** are those of de Leva times stature over mean stature. **Masses** are shares of the mass, divided by
//!   their sum. Moments of inertia are m (r l)² with the radii of gyration r.
//! - **Joints**: the hip, knee, ankle, shoulder, elbow and wrist joints are the ends of the segments. Abdomen, thorax
//!   and head join at the navel, the lower end of the breastbone and the seventh neck vertebra, all on one vertical
//!   line (**assumed**: the last two lie on the front and the back).
//! - Shoulder joints are 0.170 m, hips 0.085 m from the middle of an adult of mean stature. The ankle is 0.050 m in
//!   front of the heel and 0.040 m above the centre of gravity of the foot (**assumed**).
//! - The sole is where the stature ends: its distance below the ankle is the rest that the segments leave.
//! - **Ellipsoids** have the breadths, depths and girths of ANSUR II. The height of the head's ellipsoid, 0.13 of the
//!   stature, is **assumed**.

use super::data::{Outside, Segment, Segments, outside, segments};
use super::dummy::dummy;
use super::size::{Person, Size};
use std::f64::consts::TAU;

impl Body {
    /// The mass of all elements together \[kg\].
    pub fn mass(&self) -> f64 {
        let of = |element: &Element| element.mass * if element.pair { 2.0 } else { 1.0 };
        self.elements.iter().map(of).sum()
    }
}

/// The joint between an element and the one that carries it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joint {
    /// No joint: the root.
    None,
    /// A ball joint.
    Ball,
    /// A hinge about y.
    Hinge,
    /// Hinges about y, x and z, one after the other: flexion, abduction, rotation.
    Three,
}

/// An element; for a pair, the left one.
#[derive(Clone, Debug)]
pub struct Element {
    /// Name.
    pub name: &'static str,
    /// The element that carries it, and the position of the joint on that \[m\].
    pub on: Option<(&'static str, [f64; 3])>,
    /// Its joint.
    pub joint: Joint,
    /// Whether there is a right one, too.
    pub pair: bool,
    /// Mass \[kg\].
    pub mass: f64,
    /// Position of the centre of gravity \[m\].
    pub cg: [f64; 3],
    /// Principal moments of inertia about the centre of gravity \[kg m²\].
    pub inertia: [f64; 3],
}

/// An ellipsoid of an element.
#[derive(Clone, Debug)]
pub struct Shape {
    /// Name of the element.
    pub on: &'static str,
    /// Position of the centre \[m\].
    pub center: [f64; 3],
    /// Semi-axes \[m\].
    pub semi_axes: [f64; 3],
    /// Whether there is a right one, too.
    pub pair: bool,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// The elements, each after the one that carries it.
    pub elements: Vec<Element>,
    /// Ellipsoids.
    pub shapes: Vec<Shape>,
    /// Height from sole to vertex \[m\].
    pub stature: f64,
    /// Length from hip to knee \[m\].
    pub thigh: f64,
    /// Length from knee to ankle \[m\].
    pub shank: f64,
    /// Distance from the ankle down to the sole \[m\].
    pub sole: f64,
}

/// The body of a person.
///
/// # Errors
/// If the size is outside of the range that the data can be scaled to, with the reason.
pub fn body(person: &Person) -> Result<Body, String> {
    match person {
        Person::Size(size) => {
            within(*size)?;
            made(&segments(size.sex), &outside(size.sex), *size)
        }
        Person::Dummy(name) => {
            let Some(dummy) = dummy(name) else {
                return Err(format!("there are no data of \"{name}\""));
            };
            let size = Size {
                sex: dummy.sex,
                stature: dummy.stature,
                mass: dummy.mass,
            };
            let outside = dummy.outside.unwrap_or_else(|| outside(dummy.sex));
            made(&dummy.segments, &outside, size)
        }
    }
}

/// Checks that the data of adults can be scaled to a size.
fn within(Size { stature, mass, .. }: Size) -> Result<(), String> {
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
    Ok(())
}

fn made(data: &Segments, outside: &Outside, size: Size) -> Result<Body, String> {
    let Size { stature, mass, .. } = size;
    let built = Built::new(data, stature, mass);
    let sole = stature - built.chain();
    if sole <= 0.01 {
        return Err(format!(
            "segments of {:.3} m leave nothing of a stature of {stature} m for the feet",
            built.chain()
        ));
    }
    let shapes = built.shapes(stature, sole, &|name| outside.of(name, stature, mass));
    let is_thin = |shape: &&Shape| shape.semi_axes.iter().any(|axis| *axis < 5e-3);
    if let Some(thin) = shapes.iter().find(is_thin) {
        return Err(format!(
            "{mass} kg at {stature} m leaves no breadth for the {}",
            thin.on
        ));
    }
    Ok(Body {
        elements: built.elements(),
        shapes,
        stature,
        thigh: built.length(&data.thigh),
        shank: built.length(&data.shank),
        sole,
    })
}

/// The segments and their scale factors.
struct Built<'d> {
    data: &'d Segments,
    /// Factor on lengths \[m/mm\].
    scale: f64,
    /// Factor on the mass shares \[kg\].
    mass: f64,
}

/// An element without its mass properties: name, carrier, position on the carrier, joint, and segment.
type Limb<'d> = (&'static str, &'static str, [f64; 3], Joint, &'d Segment);

impl<'d> Built<'d> {
    fn new(data: &'d Segments, stature: f64, mass: f64) -> Self {
        Built {
            data,
            scale: stature / data.stature,
            mass: mass / data.mass(),
        }
    }

    /// Length of a segment \[m\].
    fn length(&self, segment: &Segment) -> f64 {
        self.scale * segment.length
    }

    /// Height from the ankles to the top of the head \[m\].
    fn chain(&self) -> f64 {
        let data = self.data;
        let all = [
            &data.shank,
            &data.thigh,
            &data.pelvis,
            &data.abdomen,
            &data.thorax,
            &data.head,
        ];
        all.map(|segment| self.length(segment)).iter().sum()
    }

    /// The spine above the pelvis, upwards.
    fn spine(&self) -> [Limb<'_>; 3] {
        let data = self.data;
        let above = |segment: &Segment| [0.0, 0.0, self.length(segment)];
        [
            (
                "abdomen",
                "pelvis",
                above(&data.pelvis),
                Joint::Ball,
                &data.abdomen,
            ),
            (
                "thorax",
                "abdomen",
                above(&data.abdomen),
                Joint::Ball,
                &data.thorax,
            ),
            (
                "head",
                "thorax",
                above(&data.thorax),
                Joint::Ball,
                &data.head,
            ),
        ]
    }

    /// The limbs of the left side, downwards.
    fn limbs(&self) -> [Limb<'_>; 6] {
        let data = self.data;
        let below = |segment: &Segment| [0.0, 0.0, -self.length(segment)];
        let shoulders = self.scale * data.shoulder_to_hip;
        let shoulder_height = shoulders - self.length(&data.pelvis) - self.length(&data.abdomen);
        let shoulder = [0.0, self.scale * data.half_shoulders, shoulder_height];
        let hip = [0.0, self.scale * data.half_hips, 0.0];
        [
            (
                "left-upper-arm",
                "thorax",
                shoulder,
                Joint::Three,
                &data.upper_arm,
            ),
            (
                "left-forearm",
                "left-upper-arm",
                below(&data.upper_arm),
                Joint::Hinge,
                &data.forearm,
            ),
            (
                "left-hand",
                "left-forearm",
                below(&data.forearm),
                Joint::Hinge,
                &data.hand,
            ),
            ("left-thigh", "pelvis", hip, Joint::Three, &data.thigh),
            (
                "left-shank",
                "left-thigh",
                below(&data.thigh),
                Joint::Hinge,
                &data.shank,
            ),
            (
                "left-foot",
                "left-shank",
                below(&data.shank),
                Joint::Hinge,
                &data.foot,
            ),
        ]
    }

    /// All elements: the spine upwards, limbs downwards.
    fn elements(&self) -> Vec<Element> {
        let data = self.data;
        let up = |segment: &Segment| [0.0, 0.0, (1.0 - segment.com) * self.length(segment)];
        let down = |segment: &Segment| [0.0, 0.0, -segment.com * self.length(segment)];
        let mut elements = vec![Element {
            name: "pelvis",
            on: None,
            joint: Joint::None,
            pair: false,
            mass: self.mass * data.pelvis.mass,
            cg: up(&data.pelvis),
            inertia: self.inertia(&data.pelvis),
        }];
        let with = |(name, on, at, joint, segment): Limb<'_>, pair, cg| Element {
            name,
            on: Some((on, at)),
            joint,
            pair,
            mass: self.mass * segment.mass,
            cg,
            inertia: self.inertia(segment),
        };
        elements.extend(self.spine().map(|one| with(one, false, up(one.4))));
        elements.extend(self.limbs().map(|one| with(one, true, down(one.4))));
        if let Some(foot) = elements.last_mut() {
            // the foot lies: its long axis is x
            let [sagittal, transverse, longitudinal] = foot.inertia;
            foot.inertia = [longitudinal, transverse, sagittal];
            let before_heel = data.foot.com * self.length(&data.foot);
            foot.cg = [
                before_heel - self.scale * data.heel,
                0.0,
                -self.scale * data.foot_below_ankle,
            ];
        }
        elements
    }

    /// Moments of inertia about the sagittal, transverse and longitudinal axis \[kg m²\].
    fn inertia(&self, segment: &Segment) -> [f64; 3] {
        let (mass, length) = (self.mass * segment.mass, self.length(segment));
        segment.radii.map(|radius| {
            let r = radius * length;
            mass * (r * r)
        })
    }

    /// All ellipsoids. `size` gives outer dimensions \[m\], `sole` is the distance of the soles below the ankles \[m\].
    fn shapes(&self, stature: f64, sole: f64, size: &dyn Fn(&str) -> f64) -> Vec<Shape> {
        let data = self.data;
        let trunk = |on, segment: &Segment, depth, breadth| {
            let length = self.length(segment);
            Shape {
                on,
                center: [0.0, 0.0, 0.5 * length],
                semi_axes: [0.5 * size(depth), 0.5 * size(breadth), 0.75 * length],
                pair: false,
            }
        };
        let limb = |on, segment: &Segment, girth| {
            let (length, radius) = (self.length(segment), size(girth) / TAU);
            Shape {
                on,
                center: [0.0, 0.0, -0.5 * length],
                semi_axes: [radius, radius, 0.5 * length],
                pair: true,
            }
        };
        let (head, half) = (self.length(&data.head), 0.5 * data.head_height * stature);
        let foot = 0.5 * self.length(&data.foot);
        vec![
            trunk("pelvis", &data.pelvis, "buttock_depth", "hip_breadth"),
            trunk("abdomen", &data.abdomen, "waist_depth", "waist_breadth"),
            trunk("thorax", &data.thorax, "chest_depth", "chest_breadth"),
            Shape {
                on: "head",
                center: [0.0, 0.0, head - half],
                semi_axes: [0.5 * size("head_length"), 0.5 * size("head_breadth"), half],
                pair: false,
            },
            limb("left-upper-arm", &data.upper_arm, "biceps_girth"),
            limb("left-forearm", &data.forearm, "forearm_girth"),
            limb("left-thigh", &data.thigh, "thigh_girth"),
            limb("left-shank", &data.shank, "calf_girth"),
            Shape {
                on: "left-foot",
                center: [foot - self.scale * data.heel, 0.0, -0.5 * sole],
                semi_axes: [foot, 0.5 * size("foot_breadth"), 0.5 * sole],
                pair: true,
            },
        ]
    }
}
