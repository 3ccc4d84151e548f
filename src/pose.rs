//! The positions of all bodies: x_c = x_p + A_p s_c, computed from the root of each tree to its leaves.
//!
//! The coordinates of a tree are those of its reference joint, if it is free, and then those of each element. An
//! element on a ball joint has an absolute orientation: one angle in the plane, three Bryant angles or a unit
//! quaternion (w, x, y, z) in space. Another element has the freedoms of its joint, relative to its carrier.
//! States in Bryant angles may be in another chart; they must be converted to [quaternions](crate::orientation) first.

use bryant_engine::table;
use bryant_generator::model::placement::placed;
use bryant_generator::model::{
    Attachment, Body, Dimension, ElementId, FieldComponent, Given, Joint, Model, Number, Reference,
    Translation, Vehicle,
};

/// A vector in absolute or local axes.
pub type Vec3 = [f64; 3];

/// A local frame: its rotation and its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// A, which converts local to absolute vectors, by rows.
    pub rotation: [Vec3; 3],
    /// Position of the joint that carries the element, absolute \[m\].
    pub origin: Vec3,
}

/// Frames of every element of a model at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    vehicles: Vec<Frame>,
    systems: Vec<Vec<Frame>>,
}

/// The places of the coordinates of joints and elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    systems: Vec<SystemLayout>,
    len: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct SystemLayout {
    /// For each absolute axis, the index of the coordinate of the reference joint; `None` if it has none.
    reference: [Option<usize>; 3],
    /// First coordinate and number of coordinates of each element.
    elements: Vec<(usize, usize)>,
}

/// The coordinates with these names do not belong to the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the coordinates do not fit the model: {0}")]
pub struct Mismatch(String);

impl Layout {
    /// Finds the coordinates by their names: `man.x` belongs to the reference joint of the system man; a name with
    /// `man/head` before its last dot belongs to the element head of this system.
    pub fn new<S: AsRef<str>>(model: &Model, names: &[S]) -> Result<Self, Mismatch> {
        let owner = |name: &str| {
            name.rsplit_once('.')
                .map_or("", |(owner, _)| owner)
                .to_owned()
        };
        let owners: Vec<String> = names.iter().map(|n| owner(n.as_ref())).collect();
        let systems = model.systems.iter().map(|system| {
            let reference = ["x", "y", "z"].map(|axis| {
                let wanted = format!("{}.{axis}", system.name);
                names.iter().position(|name| name.as_ref() == wanted)
            });
            let elements = system.elements.iter().map(|element| {
                let wanted = format!("{}/{}", system.name, element.name);
                let first = owners.iter().position(|owner| *owner == wanted);
                let count = owners.iter().filter(|owner| **owner == wanted).count();
                let own = element.joint.freedoms().iter().filter(|f| f.is_own());
                let fits = element.joint.turns_with_carrier() && count == own.count();
                match (first, count, model.dimension) {
                    (first, count, _) if fits => Ok((first.unwrap_or_default(), count)),
                    _ if element.joint.turns_with_carrier() => {
                        Err(Mismatch(format!("{count} of element \"{wanted}\"")))
                    }
                    (Some(first), 1, Dimension::Plane) | (Some(first), 3 | 4, Dimension::Space) => {
                        Ok((first, count))
                    }
                    _ => Err(Mismatch(format!("{count} of element \"{wanted}\""))),
                }
            });
            let elements = elements.collect::<Result<_, _>>()?;
            Ok(SystemLayout {
                reference,
                elements,
            })
        });
        Ok(Self {
            systems: systems.collect::<Result<_, _>>()?,
            len: names.len(),
        })
    }
}

impl Pose {
    /// The pose at time `t` \[s\] and coordinates `q`, for parameters in the model's order (SI); `None` if `q` is too
    /// short.
    pub fn new(
        model: &Model,
        layout: &Layout,
        parameters: &[f64],
        t: f64,
        q: &[f64],
    ) -> Option<Self> {
        if q.len() < layout.len {
            return None;
        }
        let numbers = Numbers { model, parameters };
        let vehicles: Vec<Frame> = model
            .vehicles
            .iter()
            .map(|vehicle| numbers.vehicle(vehicle, t))
            .collect();
        let systems = model.systems.iter().zip(&layout.systems);
        let systems = systems.map(|(system, layout)| {
            let start = numbers.vector(&system.position);
            let given = match &system.reference {
                Reference::Free | Reference::Fixed => start,
                Reference::Riding { vehicle, at } => vehicles[*vehicle].point(numbers.vector(at)),
                Reference::Prescribed(translation) => {
                    let velocity = numbers.vector(&system.velocity);
                    numbers.moved(translation, start, velocity, t)
                }
            };
            let reference: Vec3 =
                std::array::from_fn(|axis| layout.reference[axis].map_or(given[axis], |i| q[i]));
            let mut frames: Vec<Frame> = Vec::with_capacity(system.elements.len());
            for (element, &(first, count)) in system.elements.iter().zip(&layout.elements) {
                let origin = match element.parent {
                    Some(parent) => frames[parent].point(numbers.vector(&element.at)),
                    None => reference,
                };
                let own = &q[first..first + count];
                frames.push(match &element.joint {
                    Joint::Ball => Frame {
                        rotation: rotation(own),
                        origin,
                    },
                    Joint::Freedoms(freedoms) => {
                        let carrier = match (element.parent, &system.reference) {
                            (Some(parent), _) => frames[parent],
                            (None, Reference::Riding { vehicle, .. }) => vehicles[*vehicle],
                            (None, _) => Frame::ABSOLUTE,
                        };
                        let mut own = own.iter();
                        let q: Vec<f64> = (freedoms.iter())
                            .filter_map(|freedom| match &freedom.follows {
                                None => own.next().copied(),
                                Some(follows) => {
                                    let before = follows.coordinate(&system.elements);
                                    let leader = q[layout.elements[follows.element].0 + before];
                                    let (ratio, offset) = (&follows.ratio, &follows.offset);
                                    Some(numbers.value(ratio) * leader + numbers.value(offset))
                                }
                            })
                            .collect();
                        let (rotation, origin) =
                            placed((carrier.rotation, origin), freedoms, &q, parameters);
                        Frame { rotation, origin }
                    }
                });
            }
            frames
        });
        let systems = systems.collect();
        Some(Self { vehicles, systems })
    }

    /// The pose at the model's own start. Prescribed motions are at time `t` \[s\].
    pub fn at_start(model: &Model, parameters: &[f64], t: f64) -> Option<Self> {
        let numbers = Numbers { model, parameters };
        let (mut names, mut q) = (Vec::new(), Vec::new());
        let mut add = |name: String, value: f64| {
            names.push(name);
            q.push(value);
        };
        for system in &model.systems {
            if matches!(system.reference, Reference::Free) {
                let position = numbers.vector(&system.position);
                for (axis, value) in ["x", "y", "z"].into_iter().zip(position) {
                    add(format!("{}.{axis}", system.name), value);
                }
            }
            for element in &system.elements {
                let name = format!("{}/{}.start", system.name, element.name);
                let angles = numbers.vector(&element.angles);
                match (&element.joint, model.dimension) {
                    (Joint::Ball, Dimension::Plane) => add(name, angles[1]),
                    (Joint::Ball, Dimension::Space) => {
                        angles
                            .into_iter()
                            .for_each(|angle| add(name.clone(), angle));
                    }
                    (Joint::Freedoms(all), _) => {
                        let own = all.iter().filter(|freedom| freedom.is_own());
                        own.for_each(|one| add(name.clone(), numbers.value(&one.position)));
                    }
                }
            }
        }
        let layout = Layout::new(model, &names).ok()?;
        Pose::new(model, &layout, parameters, t, &q)
    }

    /// Frame of an element.
    pub fn frame(&self, id: ElementId) -> Frame {
        self.systems[id.system][id.element]
    }

    /// Frame of an element or a vehicle, or the absolute frame, for [`Body::Frame`].
    pub fn body(&self, body: Body) -> Frame {
        match body {
            Body::Frame => Frame::ABSOLUTE,
            Body::Element(id) => self.frame(id),
            Body::Vehicle(index) => self.vehicles[index],
        }
    }

    /// Absolute position of a point of a body \[m\].
    pub fn point(&self, numbers: &Numbers<'_>, attachment: &Attachment) -> Vec3 {
        self.body(attachment.on)
            .point(numbers.vector(&attachment.at))
    }
}

impl Frame {
    /// The absolute frame.
    pub const ABSOLUTE: Frame = Frame {
        rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        origin: [0.0; 3],
    };

    /// x + A s: the absolute position of a local point.
    pub fn point(&self, local: Vec3) -> Vec3 {
        let turned = self.direction(local);
        std::array::from_fn(|i| self.origin[i] + turned[i])
    }

    /// A s: the absolute components of a local vector.
    pub fn direction(&self, local: Vec3) -> Vec3 {
        self.rotation.map(|row| dot(row, local))
    }
}

/// A model with values of its parameters, which give its numbers.
#[derive(Clone, Copy, Debug)]
pub struct Numbers<'a> {
    /// The model.
    pub model: &'a Model,
    /// The values of its parameters: SI, in the model's order.
    pub parameters: &'a [f64],
}

impl Numbers<'_> {
    /// The values of three numbers.
    pub fn vector(&self, numbers: &[Number; 3]) -> Vec3 {
        std::array::from_fn(|i| numbers[i].value(self.parameters))
    }

    /// Position at time `t` of a point with a prescribed translation, which begins at `start`.
    fn moved(&self, translation: &Translation, start: Vec3, velocity: Vec3, t: f64) -> Vec3 {
        std::array::from_fn(|axis| {
            let mut moving = t;
            let moved = translation.curves[axis].as_ref().map_or(0.0, |scaled| {
                let curve = &self.model.curves[scaled.curve];
                let (times, stretch) = (self.value(&scaled.times), self.value(&scaled.stretch));
                let mut x = t / stretch;
                if translation.stops.is_some() {
                    let end = table(&curve.into()).stop(velocity[axis], times * stretch);
                    if 0.0 < end && end < x {
                        (x, moving) = (end, end * stretch);
                    }
                }
                times
                    * match translation.given {
                        Given::Displacement => curve.value(x),
                        Given::Velocity => stretch * curve.integral(x),
                        Given::Acceleration => stretch * stretch * curve.double_integral(x),
                    }
            });
            start[axis] + velocity[axis] * moving + moved
        })
    }

    /// Frame of a vehicle at time `t` \[s\].
    fn vehicle(&self, vehicle: &Vehicle, t: f64) -> Frame {
        let angle = |angle: &FieldComponent| match angle {
            FieldComponent::Constant(angle) => self.value(angle),
            FieldComponent::Curve(scaled) => {
                let x = t / self.value(&scaled.stretch);
                self.value(&scaled.times) * self.model.curves[scaled.curve].value(x)
            }
        };
        let (start, velocity) = (
            self.vector(&vehicle.position),
            self.vector(&vehicle.velocity),
        );
        Frame {
            rotation: bryant_rotation(std::array::from_fn(|i| angle(&vehicle.angles[i]))),
            origin: self.moved(&vehicle.translation, start, velocity, t),
        }
    }

    /// The value of a number.
    pub fn value(&self, number: &Number) -> f64 {
        number.value(self.parameters)
    }
}

/// a · b
pub fn dot(a: Vec3, b: Vec3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a × b
pub fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// Rx(φ₁) Ry(φ₂) Rz(φ₃), by rows.
pub fn bryant_rotation([a, b, c]: Vec3) -> [Vec3; 3] {
    let ((s1, c1), (s2, c2), (s3, c3)) = (libm::sincos(a), libm::sincos(b), libm::sincos(c));
    [
        [c2 * c3, -c2 * s3, s2],
        [c1 * s3 + s1 * s2 * c3, c1 * c3 - s1 * s2 * s3, -s1 * c2],
        [s1 * s3 - c1 * s2 * c3, s1 * c3 + c1 * s2 * s3, c1 * c2],
    ]
}

/// The rotation, by rows, for one angle about y, three Bryant angles (in chart 0), or a quaternion (w, x, y, z).
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub fn rotation(coordinates: &[f64]) -> [Vec3; 3] {
    match *coordinates {
        [angle] => bryant_rotation([0.0, angle, 0.0]),
        [a, b, c] => bryant_rotation([a, b, c]),
        [w, x, y, z] => {
            let s = 2.0 / (w * w + x * x + y * y + z * z);
            [
                [
                    1.0 - s * (y * y + z * z),
                    s * (x * y - w * z),
                    s * (x * z + w * y),
                ],
                [
                    s * (x * y + w * z),
                    1.0 - s * (x * x + z * z),
                    s * (y * z - w * x),
                ],
                [
                    s * (x * z - w * y),
                    s * (y * z + w * x),
                    1.0 - s * (x * x + y * y),
                ],
            ]
        }
        _ => Frame::ABSOLUTE.rotation,
    }
}

/// The unit quaternion (w, x, y, z) of a rotation, which is given by rows.
pub fn quaternion(rows: [Vec3; 3]) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = rows;
    // four times the square of each component; the largest is used as divisor
    let squares = [
        1.0 + xx + yy + zz,
        1.0 + xx - yy - zz,
        1.0 - xx + yy - zz,
        1.0 - xx - yy + zz,
    ];
    let largest = (0..4).fold(0, |best, k| match squares[k] > squares[best] {
        true => k,
        false => best,
    });
    let part = 0.5 * squares[largest].max(0.0).sqrt();
    let by = 0.25 / part;
    match largest {
        0 => [part, by * (zy - yz), by * (xz - zx), by * (yx - xy)],
        1 => [by * (zy - yz), part, by * (xy + yx), by * (xz + zx)],
        2 => [by * (xz - zx), by * (xy + yx), part, by * (yz + zy)],
        _ => [by * (yx - xy), by * (xz + zx), by * (yz + zy), part],
    }
}
