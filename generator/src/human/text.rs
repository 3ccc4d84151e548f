//! A body as YAML: a file that models can include.

use super::body::{Body, Element, Joint, body};
use super::data::{Sex, read};
use super::dummy::{Made, dummy};
use super::posture::Posture;
use super::size::{Person, Size};
use serde::Deserialize;
use std::fmt::Write as _;

/// The laws of all joints: `laws.yaml`, which says where they are from.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Laws {
    spine: Vec<Spine>,
    limbs: Vec<Limb>,
    dummy: DummyLaws,
}

/// The laws of a joint of the spine, the order of its turns, and the stops about x and about z.
#[derive(Deserialize)]
struct Spine {
    joint: String,
    order: String,
    aside: Law,
    forward: Law,
    stops: [Stop; 2],
}

/// The law of a freedom of a limb.
#[derive(Deserialize)]
struct Limb {
    joint: String,
    #[serde(default)]
    freedom: String,
    #[serde(flatten)]
    law: Law,
}

/// The laws that crash dummies have instead.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DummyLaws {
    neck_mass: f64,
    aside: Law,
    forward: Law,
    lumbar: f64,
    hip: Law,
}

/// The law of a joint: elastic torque, damping, stop.
#[derive(Deserialize)]
struct Law {
    stiffness: Option<f64>,
    #[serde(default)]
    points: Vec<[f64; 2]>,
    damping: f64,
    stop: Option<Stop>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Stop {
    between: [f64; 2],
    stiffness: f64,
    #[serde(default)]
    damping: f64,
}

impl Law {
    /// The law as YAML keys, with torques times a factor.
    fn keys(&self, factor: f64) -> String {
        let mut keys = Vec::new();
        if let Some(stiffness) = self.stiffness {
            keys.push(format!("stiffness: {}", short(factor * stiffness)));
        }
        if !self.points.is_empty() {
            let points = self.points.iter();
            let points =
                points.map(|[angle, torque]| format!("[{angle}, {}]", short(factor * torque)));
            let points: Vec<String> = points.collect();
            keys.push(format!(
                "elastic: {{ points: [{}], extrapolate: linear }}",
                points.join(", ")
            ));
        }
        keys.push(format!("damping: {}", short(factor * self.damping)));
        if let Some(stop) = &self.stop {
            keys.push(stop.key(factor));
        }
        keys.join(", ")
    }
}

impl Stop {
    /// The stop as a YAML key, with torques times a factor.
    fn key(&self, factor: f64) -> String {
        let [from, to] = self.between;
        let damping = match self.damping {
            0.0 => String::new(),
            damping => format!(", damping: {}", short(factor * damping)),
        };
        format!(
            "stop: {{ from: {from} deg, to: {to} deg, stiffness: {}{damping} }}",
            short(factor * self.stiffness)
        )
    }
}

/// A number to three digits.
fn short(x: f64) -> String {
    let text = format!("{x:.2e}");
    text.parse::<f64>().map_or(text, |x| x.to_string())
}

/// The options for writing a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Written<'n> {
    /// Name of the system.
    pub name: &'n str,
    /// The posture at the start.
    pub posture: Posture,
    /// Whether the model is planar: one arm and one leg then stand for both.
    pub planar: bool,
    /// Where the elastic torques of spine and neck are 0.
    pub neutral: Neutral,
}

/// Where the elastic torques of spine and neck are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Neutral {
    /// In the posture at the start.
    #[default]
    Posture,
    /// Upright, whatever the posture.
    Upright,
}

/// The file of a person: a system with its surfaces and joint forces.
///
/// # Errors
/// If the size is outside of the range that the data can be scaled to, with the reason.
pub fn yaml(person: &Person, written: Written<'_>) -> Result<String, String> {
    let body = body(person)?;
    let name = written.name;
    let mut text = head(person, &body);
    let _ = write!(text, "systems:\n  - name: {name}\n    elements:\n");
    let scene = BodyWriter {
        body: &body,
        written,
        factor: strength(&body),
        dummy: match person {
            Person::Size(_) => None,
            Person::Dummy(name) => dummy(name),
        },
    };
    // the printed masses add up to the whole mass
    let printed = |mass: f64| (mass * 1e4).round() / 1e4;
    let others = body.elements[1..]
        .iter()
        .map(|one| printed(one.mass) * if one.pair { 2.0 } else { 1.0 });
    let root_mass = printed(body.mass()) - others.sum::<f64>();
    for element in &body.elements {
        let mass = if element.on.is_none() {
            root_mass
        } else {
            element.mass
        };
        let _ = writeln!(text, "      - {{ {} }}", scene.element(element, mass));
    }
    scene.start(&mut text);
    text.push_str("\nsurfaces:\n");
    for shape in &body.shapes {
        let mirror = if scene.mirrors(shape.pair) {
            "mirror: true, "
        } else {
            ""
        };
        let on = scene.called(shape.on);
        let _ = writeln!(
            text,
            "  {name}-{on}: {{ {mirror}on: {name}/{on}, center: {}, semi_axes: {} }}",
            scene.place(shape.center),
            scene.place(shape.semi_axes)
        );
    }
    text.push_str("\nforces:\n");
    scene.laws(&mut text);
    Ok(text)
}

/// The comment at the top: what is measured, derived and assumed.
fn head(person: &Person, body: &Body) -> String {
    let (of_body, of_joints) = match person {
        Person::Size(Size { sex, stature, mass }) => {
            let who = match sex {
                Sex::Female => "woman",
                Sex::Male => "man",
            };
            let text = format!(
                "# A {who} of {stature} m and {mass} kg.\n\
                 #\n\
                 # Masses, lengths, centres of gravity and moments of inertia: de Leva 1996, J. Biomech. 29(9), table 4, scaled by stature and mass (young adults). Derived.\n\
                 # Ellipsoids: breadths, depths and girths of ANSUR II (US Army 2012), fitted on stature and mass. Derived; the height of the head is assumed.\n\
                 # Spacing of shoulders and hips, the place of the ankle, one vertical line of the spine: assumed.\n"
            );
            (
                text,
                "usual magnitudes of sled models of a man, times mass and stature",
            )
        }
        Person::Dummy(name) => {
            let source = dummy(name).map_or(String::new(), |dummy| dummy.source);
            let text = format!(
                "# A body like {name}, {:.2} kg.\n#\n# {source}\n# docs/humans.md says how the rest is made.\n",
                body.mass()
            );
            (
                text,
                "neck, lumbar spine and stop of the hips fitted to certification tests (docs/validation.md); all others usual magnitudes of sled models of a man, times mass and stature",
            )
        }
    };
    format!(
        "{of_body}\
         # Joint torques, damping and ranges: {of_joints}. Assumed, unverified: they are not measurements.\n\
         # Frames: x forward, y left, z up, parallel where the body stands upright; the origin of each element is its joint on the one that carries it.\n\n"
    )
}

/// Factor on the torques of joints: 1 for a man of 77.7 kg and 1.753 m. Torques of others are proportional to mass
/// times stature, as in bodies of the same shape and stress.
fn strength(body: &Body) -> f64 {
    body.mass() / 77.7 * (body.stature / 1.753)
}

/// A body while it is written as text.
struct BodyWriter<'a> {
    body: &'a Body,
    written: Written<'a>,
    factor: f64,
    dummy: Option<Made>,
}

impl BodyWriter<'_> {
    /// Whether a pair is written as one side with a mirror image.
    fn mirrors(&self, pair: bool) -> bool {
        pair && !self.written.planar
    }

    /// The name of an element; in the plane, one name for both sides of a pair.
    fn called<'n>(&self, element: &'n str) -> &'n str {
        match element.strip_prefix("left-") {
            Some(both) if self.written.planar => both,
            _ => element,
        }
    }

    /// A vector; in the plane only x and z.
    fn place(&self, [x, y, z]: [f64; 3]) -> String {
        match self.written.planar {
            true => format!("[{}, {}]", number(x, 4), number(z, 4)),
            false => format!("[{}, {}, {}]", number(x, 4), number(y, 4), number(z, 4)),
        }
    }

    fn element(&self, element: &Element, mass: f64) -> String {
        let mut text = format!("name: {}", self.called(element.name));
        if self.mirrors(element.pair) {
            text.push_str(", mirror: true");
        }
        if let Some((on, at)) = element.on {
            let _ = write!(text, ", on: {}, at: {}", self.called(on), self.place(at));
        }
        text.push_str(match element.joint {
            _ if self.written.planar => "",
            Joint::None | Joint::Ball => "",
            Joint::Hinge => ", joint: { hinge: y }",
            Joint::Three => {
                ", joint: [{ hinge: y, name: flexion }, { hinge: x, name: abduction }, { hinge: z, name: rotation }]"
            }
        });
        let both = if element.pair && self.written.planar {
            2.0
        } else {
            1.0
        };
        let cg = self.place(element.cg);
        let inertia = element.inertia.map(|moment| number(both * moment, 6));
        let inertia = match self.written.planar {
            true => inertia[1].clone(),
            false => format!("[{}]", inertia.join(", ")),
        };
        let _ = write!(
            text,
            ", mass: {:.4} kg, cg: {cg}, inertia: {inertia}",
            both * mass
        );
        if element.name == "head" {
            text.push_str(match self.dummy {
                Some(_) => ", neck: lower",
                None => ", neck: within",
            });
        }
        text
    }

    fn start(&self, text: &mut String) {
        let posture = &self.written.posture;
        let height = number(posture.hip_height(self.body), 4);
        let position = match self.written.planar {
            true => format!("[0, {height}]"),
            false => format!("[0, 0, {height}]"),
        };
        let _ = writeln!(text, "    start:\n      position: {position}");
        let [trunk, head] = [posture.angle("trunk"), posture.angle("head")];
        let arm = posture.angle("upper_arms");
        let forearm = arm + posture.angle("forearms");
        let thigh = posture.angle("thighs");
        let shank = thigh + posture.angle("shanks");
        // relative to the trunk
        let spine = [
            ("pelvis", 0.0),
            ("abdomen", 0.0),
            ("thorax", 0.0),
            ("head", head),
        ];
        let limbs = [
            ("upper-arm", arm),
            ("forearm", forearm),
            ("hand", forearm + posture.angle("hands")),
            ("thigh", thigh),
            ("shank", shank),
            ("foot", shank + posture.angle("feet")),
        ];
        // names with an angle, and what is written around it
        let mut angles = |key: &str, all: &[(&str, f64, [&str; 2])]| {
            let turned = all.iter().filter(|(_, angle, _)| *angle != 0.0);
            let turned = turned.map(|(name, angle, [before, after])| {
                format!("{name}: {before}{}{after}", degrees(*angle))
            });
            let turned: Vec<String> = turned.collect();
            if !turned.is_empty() {
                let _ = writeln!(text, "      {key}: {{ {} }}", turned.join(", "));
            }
        };
        const ALONE: [&str; 2] = ["", ""];
        const FIRST: [&str; 2] = ["[", ", 0, 0]"];
        const ABOUT_Y: [&str; 2] = ["[0, ", ", 0]"];
        if self.written.planar {
            let all = spine.into_iter().chain(limbs);
            let all = all.map(|(name, angle)| (name, trunk + angle, ALONE));
            angles("angles", &all.collect::<Vec<_>>());
            return;
        }
        angles(
            "angles",
            &spine.map(|(name, angle)| (name, trunk + angle, ABOUT_Y)),
        );
        let joints = [
            ("left-thigh", "thighs", FIRST),
            ("left-shank", "shanks", ALONE),
            ("left-foot", "feet", ALONE),
            ("left-upper-arm", "upper_arms", FIRST),
            ("left-forearm", "forearms", ALONE),
            ("left-hand", "hands", ALONE),
        ];
        angles(
            "joints",
            &joints.map(|(name, of, around)| (name, posture.angle(of), around)),
        );
    }

    fn laws(&self, text: &mut String) {
        let name = self.written.name;
        let all: Laws = read(include_str!("laws.yaml"));
        for spine in &all.spine {
            let Spine {
                joint,
                order,
                stops,
                ..
            } = spine;
            let of_people = [&spine.aside, &spine.forward];
            let ([aside, forward], factor) = match (&self.dummy, &**joint) {
                (None, _) => (of_people, self.factor),
                (Some(dummy), "head") => {
                    let neck = [&all.dummy.aside, &all.dummy.forward];
                    (neck, dummy.neck / all.dummy.neck_mass)
                }
                (Some(_), _) => (of_people, all.dummy.lumbar * self.factor),
            };
            let neutral = match (self.written.neutral, &**joint) {
                // the parts of the trunk lean alike
                (Neutral::Posture, "head") => self.written.posture.angle("head"),
                _ => 0.0,
            };
            let neutral = match neutral {
                0.0 => String::new(),
                angle => format!("neutral: {}, ", degrees(angle)),
            };
            let forward = format!("{neutral}{}", forward.keys(factor));
            let law = match self.written.planar {
                true => forward,
                false => {
                    let aside = aside.keys(factor);
                    let [x, z] = stops.each_ref().map(|stop| stop.key(factor));
                    format!(
                        "about: {{ order: {order}, x: {{ {aside}, {x} }}, y: {{ {forward} }}, z: {{ {aside}, {z} }} }}"
                    )
                }
            };
            let _ = writeln!(text, "  - {{ joint: {name}/{joint}, {law} }}");
        }
        for Limb {
            joint,
            freedom,
            law,
        } in &all.limbs
        {
            let is_hip = (&**joint, &**freedom) == ("left-thigh", "flexion");
            let law = match is_hip && self.dummy.is_some() {
                true => &all.dummy.hip,
                false => law,
            };
            if self.written.planar {
                if matches!(&**freedom, "" | "flexion") {
                    let law = law.keys(2.0 * self.factor);
                    let _ = writeln!(
                        text,
                        "  - {{ joint: {name}/{}, {law} }}",
                        self.called(joint)
                    );
                }
                continue;
            }
            let freedom = match &**freedom {
                "" => String::new(),
                freedom => format!("name: {freedom}, freedom: {freedom}, "),
            };
            let _ = writeln!(
                text,
                "  - {{ joint: {name}/{joint}, mirror: true, {freedom}{} }}",
                law.keys(self.factor)
            );
        }
    }
}

/// An angle in degrees, to three decimals.
fn degrees(angle: f64) -> String {
    let text = number(angle.to_degrees(), 3);
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    format!("{text} deg")
}

fn number(x: f64, digits: usize) -> String {
    let text = format!("{x:.digits$}");
    match text.parse::<f64>() {
        // 0 has no sign, even after rounding
        Ok(0.0) => "0".to_owned(),
        _ => text,
    }
}
