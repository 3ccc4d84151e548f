//! A body as YAML: a file for models to include.

use super::body::{Body, Element, Joint, body};
use super::data::Sex;
use super::size::Size;
use std::fmt::Write as _;

/// How a body is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Posture {
    /// Upright, arms hanging.
    Standing,
    /// Thighs forward, shanks down, forearms forward.
    Seated,
}

/// Laws of the joints of the spine: about x, y and z. Positive about y leans forward.
const BALLS: [(&str, &str); 3] = [
    ("abdomen", LUMBAR),
    ("thorax", LUMBAR),
    (
        "head",
        "xz: { stiffness: 60, damping: 1 }, y: { elastic: { points: [[-1, -130], [-0.4, -26], [0, 0], [0.4, 73], [1, 320]], extrapolate: linear }, damping: 1 }",
    ),
];
const LUMBAR: &str = "xz: { stiffness: 120, damping: 3 }, y: { elastic: { points: [[-1, -1000], [-0.09, -40], [0, 0], [0.09, 40], [1, 1000]], extrapolate: linear }, damping: 3 }";
/// Laws of the freedoms of limbs. Flexion about y is negative where it lifts a thigh, an upper arm or a forearm forward, and positive where it bends a knee; abduction of the left
/// side is positive outwards.
const FREEDOMS: [(&str, &str, &str); 10] = [
    (
        "left-upper-arm",
        "flexion",
        "damping: 1.5, stop: { from: -170 deg, to: 60 deg, stiffness: 500 }",
    ),
    (
        "left-upper-arm",
        "abduction",
        "damping: 1.5, stop: { from: -20 deg, to: 70 deg, stiffness: 1500, damping: 15 }",
    ),
    (
        "left-upper-arm",
        "rotation",
        "damping: 1.5, stop: { from: -60 deg, to: 60 deg, stiffness: 500 }",
    ),
    (
        "left-forearm",
        "",
        "damping: 1.5, stop: { from: -145 deg, to: 0 deg, stiffness: 500 }",
    ),
    (
        "left-hand",
        "",
        "damping: 0.5, stop: { from: -70 deg, to: 70 deg, stiffness: 100 }",
    ),
    (
        "left-thigh",
        "flexion",
        "damping: 2, stop: { from: -120 deg, to: 15 deg, stiffness: 500 }",
    ),
    (
        "left-thigh",
        "abduction",
        "damping: 2, stop: { from: -25 deg, to: 40 deg, stiffness: 500 }",
    ),
    (
        "left-thigh",
        "rotation",
        "damping: 2, stop: { from: -35 deg, to: 40 deg, stiffness: 500 }",
    ),
    (
        "left-shank",
        "",
        "damping: 1.5, stop: { from: 0 deg, to: 140 deg, stiffness: 500 }",
    ),
    (
        "left-foot",
        "",
        "damping: 1, stop: { from: -20 deg, to: 45 deg, stiffness: 300 }",
    ),
];

/// The file of a body, for a model in space: a system of this name with its surfaces and joint forces.
///
/// # Errors
/// Outside of what the data can be stretched to, with the reason.
pub fn yaml(size: Size, name: &str, posture: Posture) -> Result<String, String> {
    let body = &body(size)?;
    let Size { sex, stature, mass } = size;
    let who = match sex {
        Sex::Female => "woman",
        Sex::Male => "man",
    };
    let mut text = format!(
        "# A {who} of {stature} m and {mass} kg.\n\
         #\n\
         # Masses, lengths, centres of gravity and moments of inertia: de Leva 1996, J. Biomech. 29(9), table 4, scaled by stature and mass (young adults). Derived.\n\
         # Ellipsoids: breadths, depths and girths of ANSUR II (US Army 2012), fitted on stature and mass. Derived; the height of the head is assumed.\n\
         # Spacing of shoulders and hips, the place of the ankle, one vertical line of the spine: assumed.\n\
         # Joint torques, damping and ranges: usual magnitudes of sled models. Assumed, unverified: they are not measurements.\n\
         # Frames: x forward, y left, z up, parallel where the body stands upright; the origin of each element is its joint on the one that carries it.\n\n\
         systems:\n  - name: {name}\n    elements:\n"
    );
    // what is printed adds up to the mass
    let printed = |mass: f64| (mass * 1e4).round() / 1e4;
    let others = body.elements[1..]
        .iter()
        .map(|one| printed(one.mass) * if one.pair { 2.0 } else { 1.0 });
    let root_mass = mass - others.sum::<f64>();
    for element in &body.elements {
        let mass = if element.on.is_none() {
            root_mass
        } else {
            element.mass
        };
        let _ = writeln!(text, "      - {{ {} }}", self::element(element, mass));
    }
    start(body, posture, &mut text);
    text.push_str("\nsurfaces:\n");
    for shape in &body.shapes {
        let mirror = if shape.pair { "mirror: true, " } else { "" };
        let _ = writeln!(
            text,
            "  {}: {{ {mirror}on: {name}/{}, center: {}, semi_axes: {} }}",
            surface(name, shape.on),
            shape.on,
            vector(shape.center, 4),
            vector(shape.semi_axes, 4)
        );
    }
    text.push_str("\nforces:\n");
    for (joint, laws) in BALLS {
        let _ = writeln!(text, "  - {{ joint: {name}/{joint}, about: {{ {laws} }} }}");
    }
    for (joint, freedom, law) in FREEDOMS {
        let freedom = match freedom {
            "" => String::new(),
            freedom => format!("name: {freedom}, freedom: {freedom}, "),
        };
        let _ = writeln!(
            text,
            "  - {{ joint: {name}/{joint}, mirror: true, {freedom}{law} }}"
        );
    }
    Ok(text)
}

/// The name of a surface, which is one in the whole model; `left` stays where a mirror finds it.
fn surface(name: &str, element: &str) -> String {
    match element.strip_prefix("left-") {
        Some(part) => format!("{name}-left-{part}"),
        None => format!("{name}-{element}"),
    }
}

fn element(element: &Element, mass: f64) -> String {
    let mut text = format!("name: {}", element.name);
    if element.pair {
        text.push_str(", mirror: true");
    }
    if let Some((on, at)) = element.on {
        let _ = write!(text, ", on: {on}, at: {}", vector(at, 4));
    }
    text.push_str(match element.joint {
        Joint::None | Joint::Ball => "",
        Joint::Hinge => ", joint: { hinge: y }",
        Joint::Three => {
            ", joint: [{ hinge: y, name: flexion }, { hinge: x, name: abduction }, { hinge: z, name: rotation }]"
        }
    });
    let _ = write!(
        text,
        ", mass: {mass:.4} kg, cg: {}, inertia: {}",
        vector(element.cg, 4),
        vector(element.inertia, 6)
    );
    text
}

fn start(body: &Body, posture: Posture, text: &mut String) {
    let height = match posture {
        Posture::Standing => body.hip_height,
        Posture::Seated => body.knee_height,
    };
    let _ = writeln!(text, "    start:\n      position: [0, 0, {height:.4}]");
    if posture == Posture::Seated {
        text.push_str(
            "      joints: { left-thigh: [-90 deg, 0, 0], left-shank: 90 deg, left-upper-arm: [-30 deg, 0, 0], left-forearm: -60 deg }\n",
        );
    }
}

fn vector(v: [f64; 3], digits: usize) -> String {
    let number = |x: f64| {
        let text = format!("{x:.digits$}");
        // what rounding makes of 0 has no sign
        match text.parse::<f64>() {
            Ok(0.0) => "0".to_owned(),
            _ => text,
        }
    };
    format!("[{}]", v.map(number).join(", "))
}
