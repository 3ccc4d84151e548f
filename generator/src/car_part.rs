//! Parts of a car, by name, as text that a model includes: surfaces, curves and contacts with people.
//!
//! | part | what |
//! |---|---|
//! | `cushion` | the plane of a seat cushion of foam |
//! | `seat` | a cushion and a seat back |
//! | `knee-bolster` | a padded panel before the knees |
//! | `steering-column` | a steering wheel with hub and rim, on a column that yields along its axis |
//!
//! The planes are in `car_part.yaml`. All numbers are usual magnitudes of sled models: **assumed**.

use crate::human::read;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The kind of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CarPartKind {
    /// The plane of a seat cushion.
    Cushion,
    /// A cushion and a back.
    Seat,
    /// A padded panel before the knees.
    KneeBolster,
    /// A steering wheel on a column that yields.
    SteeringColumn,
}

/// A part and its place.
#[derive(Clone, Debug)]
pub struct CarPart {
    /// The kind of the part.
    pub kind: CarPartKind,
    /// The names of all its surfaces, curves and contacts begin with this.
    pub name: String,
    /// The name of the vehicle; or `frame`.
    pub on: String,
    /// Position x, y, z in the frame of the vehicle \[m\]; y is 0 in the plane.
    pub at: [f64; 3],
    /// Inclination about y \[rad\]; `None` for the usual one.
    pub angle: Option<f64>,
    /// The systems (people) that the part is in contact with.
    pub against: Vec<String>,
    /// Factor on all forces: a number or the name of a parameter.
    pub times: String,
    /// True for a planar model.
    pub planar: bool,
}

/// Force of the padding of a wheel, against the depth \[mm, N\].
const PADDING: &str = "[[0, 0], [10, 1500], [30, 5000], [60, 15000], [120, 50000]]";
/// Force along a column \[m, N\]: the column breaks away at 2 kN, yields at up to 3 kN over 100 mm, and then hits its
/// end.
const COLUMN: &str =
    "[[-0.02, -20000], [0, 0], [0.004, 2000], [0.1, 3000], [0.11, 10000], [0.13, 40000]]";

impl CarPart {
    /// The text of a file with this part.
    pub fn yaml(&self) -> String {
        let mut text = format!(
            "# {}: usual magnitudes of sled models, assumed.\n",
            self.name
        );
        match self.kind {
            CarPartKind::Cushion => self.planes(&mut text, &["cushion"]),
            CarPartKind::Seat => self.planes(&mut text, &["cushion", "back"]),
            CarPartKind::KneeBolster => self.planes(&mut text, &["panel"]),
            CarPartKind::SteeringColumn => self.column(&mut text),
        }
        text
    }

    /// The text of a vector; in the plane of x and z only.
    fn vector(&self, [x, y, z]: [f64; 3]) -> String {
        // rounded to 0.1 µm; a zero that rounding made negative loses its sign
        let [x, y, z] = [x, y, z].map(|value| (value * 1e7).round() / 1e7 + 0.0);
        match self.planar {
            true => format!("[{x}, {z}]"),
            false => format!("[{x}, {y}, {z}]"),
        }
    }

    /// The place of the part, moved by a distance along x and z \[m\].
    fn beside(&self, [dx, dz]: [f64; 2]) -> [f64; 3] {
        let [x, y, z] = self.at;
        [x + dx, y, z + dz]
    }

    fn extent(&self, [along, across]: [f64; 2]) -> String {
        match self.planar {
            true => along.to_string(),
            false => format!("[{along}, {across}]"),
        }
    }

    /// The surfaces of a person that can touch the part, by their names in models of people.
    fn surfaces(&self, person: &str, parts: &[impl AsRef<str>]) -> Vec<String> {
        let sides = |part: &str| match part.strip_prefix("both-") {
            Some(limb) if self.planar => vec![format!("{person}-{limb}")],
            Some(limb) => vec![
                format!("{person}-left-{limb}"),
                format!("{person}-right-{limb}"),
            ],
            None => vec![format!("{person}-{part}")],
        };
        parts.iter().flat_map(|part| sides(part.as_ref())).collect()
    }

    /// Writes some of the planes, of which the last one leans as the part does.
    fn planes(&self, text: &mut String, parts: &[&str]) {
        let CarPart {
            name, on, times, ..
        } = self;
        let all: BTreeMap<String, Plane> = read(include_str!("car_part.yaml"));
        let planes: Vec<(&str, &Plane)> = parts.iter().map(|part| (*part, &all[*part])).collect();
        text.push_str("curves:\n");
        for (part, plane) in &planes {
            let _ = writeln!(
                text,
                "  {name}-{part}: {{ unit: [mm, N], points: {}, extrapolate: linear }}",
                plane.points
            );
        }
        text.push_str("surfaces:\n");
        for (part, plane) in &planes {
            let of_part = self.angle.filter(|_| parts.last() == Some(part));
            let leans = plane.from.to_radians() + of_part.unwrap_or(plane.leans.to_radians());
            let normal = [libm::cos(leans), 0.0, libm::sin(leans)];
            let along = match self.planar {
                true => String::new(),
                false => format!(", along: {}", self.vector([normal[2], 0.0, -normal[0]])),
            };
            let _ = writeln!(
                text,
                "  {name}-{part}: {{ on: {on}, at: {}, normal: {}{along}, extent: {} }}",
                self.vector(self.beside(plane.beside)),
                self.vector(normal),
                self.extent(plane.extent)
            );
        }
        if self.against.is_empty() {
            return;
        }
        text.push_str("forces:\n");
        for (part, plane) in &planes {
            for person in &self.against {
                let surfaces = self.surfaces(person, &plane.meets).join(", ");
                let _ = writeln!(
                    text,
                    "  - {{ contact: {name}-{part}, ellipsoid: [{surfaces}], plane: {name}-{part}, elastic: {{ curve: {name}-{part}, times: {times} }}, {} }}",
                    plane.keys
                );
            }
        }
    }

    fn column(&self, text: &mut String) {
        let CarPart {
            name, on, times, ..
        } = self;
        let tilt = self.angle.unwrap_or(25f64.to_radians());
        // away from the driver, and downwards
        let axis = [libm::cos(tilt), 0.0, -libm::sin(tilt)];
        let rim = match self.planar {
            true => ("[0.02, 0.19]".to_owned(), format!("{tilt}")),
            false => ("[0.02, 0.19, 0.19]".to_owned(), format!("[0, {tilt}, 0]")),
        };
        let hub = match self.planar {
            true => "[0.08, 0.08]",
            false => "[0.08, 0.08, 0.08]",
        };
        let inertia = if self.planar {
            "0.05"
        } else {
            "[0.09, 0.05, 0.05]"
        };
        let behind = axis.map(|part| 0.1 * part);
        let _ = write!(
            text,
            "curves:\n  {name}-column: {{ points: {COLUMN}, extrapolate: linear }}\n  {name}-padding: {{ unit: [mm, N], points: {PADDING}, extrapolate: linear }}\n\
             systems:\n  - name: {name}\n    reference: {{ on: {on}, at: {} }}\n    elements: [{{ name: wheel, joint: {{ slider: {} }}, mass: 4 kg, cg: {zero}, inertia: {inertia} }}]\n\
             surfaces:\n  {name}-rim: {{ on: {name}/wheel, center: {zero}, semi_axes: {}, axes: {} }}\n  {name}-hub: {{ on: {name}/wheel, center: {}, semi_axes: {hub} }}\n\
             forces:\n  - {{ joint: {name}/wheel, elastic: {{ curve: {name}-column, times: {times} }}, unloading_slope: 2e6 N/m * {times}, damping: 200 }}\n",
            self.vector(self.at),
            self.vector(axis),
            rim.0,
            rim.1,
            self.vector(behind),
            zero = self.vector([0.0; 3]),
        );
        for person in &self.against {
            for (meets, part) in [("thorax", "hub"), ("abdomen", "rim"), ("head", "rim")] {
                let surface = self.surfaces(person, &[meets]).join(", ");
                let _ = writeln!(
                    text,
                    "  - {{ contact: {name}-{part}-{surface}, ellipsoid: {surface}, with: {name}-{part}, elastic: {{ curve: {name}-padding, times: {times} }}, unloading_slope: 2e6 N/m * {times}, damping: 200 }}"
                );
            }
        }
    }
}

/// A plane that belongs to a part: an entry of `car_part.yaml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Plane {
    /// The force against the depth \[mm, N\].
    points: String,
    keys: String,
    /// Place along x and z, from that of the part \[m\].
    #[serde(default)]
    beside: [f64; 2],
    /// Direction of the normal in the plane x–z, from x towards z: an angle, and the usual inclination from there
    /// \[deg\].
    from: f64,
    leans: f64,
    /// Half-lengths along and across \[m\].
    extent: [f64; 2],
    meets: Vec<String>,
}
