//! The moving parts of a report: bodies, their shapes, and the forces between them, at every sample.

use crate::picture::Instant;
use crate::picture::figure::{belt_lengths, ellipsoids, ends, surfaces};

use crate::pose::{Frame, Layout, Mismatch, Numbers, Pose, Vec3, bryant_rotation, dot};
use bryant_generator::model::{
    Against, Attachment, Body, Component, Dimension, ElementId, ForceKind, Freedom, Model, Number,
    Output, Projection, Quantity,
};
use serde_json::{Value, json};

/// The model with additional outputs after its own: the force of every contact, spring and belt segment on the first of its two bodies,
/// along x, y and z.
pub fn with_forces(model: &Model) -> Model {
    let mut model = model.clone();
    for (index, force) in model.forces.iter().enumerate() {
        for line in 0..lines(&force.kind) {
            for component in [Component::X, Component::Y, Component::Z] {
                let projection = Projection::absolute(component);
                let quantity = match &force.kind {
                    // the segment pulls with the force that acts on all points before it
                    ForceKind::Belt(belt) if !belt.rings.is_empty() => Quantity::ForceOnPoints {
                        force: index,
                        points: (0..=line).collect(),
                        projection,
                    },
                    _ => Quantity::ForceOn {
                        force: index,
                        on_second: false,
                        projection,
                    },
                };
                model.outputs.push(Output {
                    name: format!("report force {index} {line} {component:?}"),
                    quantity,
                    unit: "N".into(),
                    code: None,
                    filter: None,
                    channel: None,
                });
            }
        }
    }
    model
}

/// The number of lines along which a force acts between bodies: a belt acts along each of its segments.
pub fn lines(kind: &ForceKind) -> usize {
    match kind {
        ForceKind::Contact(_) | ForceKind::Spring(_) | ForceKind::Bushing(_) => 1,
        ForceKind::Belt(belt) => belt.rings.len() + 1,
        _ => 0,
    }
}

/// A number with six digits.
pub fn short(value: f64) -> Value {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(f64::NAN);
    match rounded {
        // -0 would take two letters more than 0
        0.0 => json!(0),
        _ => json!(rounded),
    }
}

fn vector(vector: Vec3) -> Value {
    vector.map(short).to_vec().into()
}

/// The unit quaternion (w, x, y, z) of a rotation by rows.
fn quaternion(rows: [Vec3; 3]) -> [f64; 4] {
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = rows;
    // four times the square of each component; the code divides by the largest
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

/// A scene in motion.
pub struct Scene<'a> {
    model: &'a Model,
    numbers: Numbers<'a>,
    poses: Vec<(f64, Pose)>,
    /// Index of the first body of each system; vehicles follow after all elements.
    first: Vec<usize>,
}

impl<'a> Scene<'a> {
    /// A scene at these instants. `coordinates` are the names of q, `parameters` the values of the run.
    ///
    /// # Errors
    /// The coordinates do not belong to the model.
    pub fn new(
        model: &'a Model,
        coordinates: &[String],
        parameters: &'a [f64],
        instants: &[Instant],
    ) -> Result<Self, Mismatch> {
        let layout = Layout::new(model, coordinates)?;
        let finite = |instant: &&Instant| instant.coordinates.iter().all(|q| q.is_finite());
        let poses = instants.iter().filter(finite).filter_map(|instant| {
            let q = &instant.coordinates;
            let pose = Pose::new(model, &layout, parameters, instant.time, q)?;
            Some((instant.time, pose))
        });
        let mut count = 0;
        let first = model.systems.iter().map(|system| {
            count += system.elements.len();
            count - system.elements.len()
        });
        Ok(Scene {
            model,
            numbers: Numbers { model, parameters },
            first: first.collect(),
            poses: poses.collect(),
        })
    }

    /// The whole scene. `forces` has a column for each output that [`with_forces`] adds, with a value for each instant.
    pub fn json(&self, forces: &[Vec<f64>]) -> Value {
        json!({
            "planar": self.model.dimension == Dimension::Plane,
            "times": self.poses.iter().map(|(t, _)| short(*t)).collect::<Vec<_>>(),
            "bodies": self.bodies(),
            "frames": self.frames(),
            "bones": self.bones(),
            "points": self.points(),
            "ellipsoids": self.ellipsoids(),
            "planes": self.planes(),
            "lines": self.lines(forces),
            "pushes": self.pushes(forces),
        })
    }

    /// The index of a body: −1 is the frame.
    pub fn index(&self, body: Body) -> i64 {
        let elements: usize = self.model.systems.iter().map(|s| s.elements.len()).sum();
        match body {
            Body::Frame => -1,
            Body::Element(id) => (self.first[id.system] + id.element) as i64,
            Body::Vehicle(index) => (elements + index) as i64,
        }
    }

    fn ids(&self) -> impl Iterator<Item = ElementId> + '_ {
        let systems = self.model.systems.iter().enumerate();
        systems.flat_map(|(system, of)| {
            (0..of.elements.len()).map(move |element| ElementId { system, element })
        })
    }

    fn bodies(&self) -> Value {
        let elements = self.ids().map(|id| {
            let system = &self.model.systems[id.system];
            let element = &system.elements[id.element];
            let name = format!("{}/{}", system.name, element.name);
            let parent = element.parent.map(|parent| self.first[id.system] + parent);
            json!({ "name": name, "system": id.system, "parent": parent })
        });
        let vehicles = self.model.vehicles.iter();
        let vehicles = vehicles.map(|vehicle| json!({ "name": vehicle.name, "system": -1 }));
        elements.chain(vehicles).collect()
    }

    /// The points that outputs refer to: body and position, by the first output of each point.
    fn points(&self) -> Value {
        let mut found: Vec<(Value, Value)> = Vec::new();
        let mut points = Vec::new();
        for output in &self.model.outputs {
            let Quantity::Point { body, at, .. } = &output.quantity else {
                continue;
            };
            let place = (json!(self.index(*body)), vector(self.numbers.vector(at)));
            if !found.contains(&place) {
                let name = format!("point of {}", output.name);
                points.push(json!({ "name": name, "body": place.0, "at": place.1 }));
                found.push(place);
            }
        }
        points.into()
    }

    /// Position and quaternion of each body at each time.
    fn frames(&self) -> Value {
        let of_pose = |(_, pose): &(f64, Pose)| -> Value {
            let vehicles = (0..self.model.vehicles.len()).map(Body::Vehicle);
            let bodies = self.ids().map(Body::Element).chain(vehicles);
            let numbers = bodies.flat_map(|body| {
                let Frame { rotation, origin } = pose.body(body);
                let [w, x, y, z] = quaternion(rotation);
                [origin[0], origin[1], origin[2], w, x, y, z].map(short)
            });
            numbers.collect()
        };
        self.poses.iter().map(of_pose).collect()
    }

    /// Lines from joint to joint: body and position of both ends.
    fn bones(&self) -> Value {
        let mut bones = Vec::new();
        for id in self.ids() {
            let elements = &self.model.systems[id.system].elements;
            let body = self.index(Body::Element(id));
            let mut tip = true;
            for (index, child) in elements.iter().enumerate() {
                if child.parent != Some(id.element) {
                    continue;
                }
                let at = self.numbers.vector(&child.at);
                if child.joint.freedoms().iter().any(Freedom::slides) {
                    let child = Body::Element(ElementId {
                        element: index,
                        ..id
                    });
                    bones.push(json!([body, vector(at), self.index(child), [0, 0, 0]]));
                }
                if dot(at, at) > 0.0 {
                    bones.push(json!([body, [0, 0, 0], body, vector(at)]));
                    tip = false;
                }
            }
            if tip {
                for end in ends(self.numbers, &elements[id.element]) {
                    bones.push(json!([body, [0, 0, 0], body, vector(end)]));
                }
            }
        }
        bones.into()
    }

    /// Ellipsoids, each once.
    fn ellipsoids(&self) -> Value {
        let mut found: Vec<Value> = Vec::new();
        for (center, semi_axes, axes, degree) in ellipsoids(self.model) {
            let mut semi = self.numbers.vector(semi_axes);
            if self.model.dimension == Dimension::Plane {
                semi[1] = semi[0].min(semi[2]);
            }
            let axes = bryant_rotation(self.numbers.vector(axes));
            let shape = json!({
                "body": self.index(center.on),
                "at": vector(self.numbers.vector(&center.at)),
                "turn": quaternion(axes).map(short),
                "semi": vector(semi),
                "degree": degree,
            });
            if !found.contains(&shape) {
                found.push(shape);
            }
        }
        found.into()
    }

    fn planes(&self) -> Value {
        let found = surfaces(self.model, self.numbers, &self.poses);
        let planes = found.iter().map(|surface| {
            json!({
                "body": self.index(surface.on),
                "corners": surface.corners().map(vector),
                "normal": vector(surface.normal),
            })
        });
        planes.collect()
    }

    fn place(&self, attachment: &Attachment) -> [Value; 2] {
        let at = vector(self.numbers.vector(&attachment.at));
        [json!(self.index(attachment.on)), at]
    }

    /// Belts, springs and bushings: both ends, and the force at each time, positive where it pulls.
    fn lines(&self, forces: &[Vec<f64>]) -> Value {
        let lengths = belt_lengths(self.numbers, &self.poses);
        let mut columns = Columns::new(self.model, forces);
        let mut belts = 0;
        let mut all = Vec::new();
        for force in &self.model.forces {
            let (kind, points): (_, Vec<&Attachment>) = match &force.kind {
                ForceKind::Belt(belt) => ("belt", belt.points().collect()),
                ForceKind::Spring(spring) => ("spring", vec![&spring.from, &spring.to]),
                ForceKind::Bushing(bushing) => ("bushing", vec![&bushing.from.on, &bushing.to.on]),
                other => {
                    columns.skip(other);
                    continue;
                }
            };
            // a segment of a belt with several has no length of its own, because webbing slips
            let length = match kind {
                "belt" => {
                    belts += 1;
                    let alone = points.len() == 2;
                    let length = lengths.get(belts - 1).filter(|_| alone);
                    length.map_or(Value::Null, |l| short(*l))
                }
                _ => Value::Null,
            };
            for ends in points.windows(2) {
                let column = columns.next();
                let pulls = self.poses.iter().enumerate().map(|(k, (_, pose))| {
                    let [from, to] = [0, 1].map(|end| pose.point(&self.numbers, ends[end]));
                    let along: Vec3 = std::array::from_fn(|i| to[i] - from[i]);
                    let size = dot(along, along).sqrt();
                    short(dot(column.at(k), along) / size.max(1e-12))
                });
                all.push(json!({
                    "name": force.name,
                    "kind": kind,
                    "from": self.place(ends[0]),
                    "to": self.place(ends[1]),
                    "length": length,
                    "force": pulls.collect::<Vec<_>>(),
                }));
            }
        }
        all.into()
    }

    /// The contacts that act at each time: index, point, and the force on the first body.
    fn pushes(&self, forces: &[Vec<f64>]) -> Value {
        let mut columns = Columns::new(self.model, forces);
        let mut at_times: Vec<Vec<Value>> = vec![Vec::new(); self.poses.len()];
        for (index, force) in self.model.forces.iter().enumerate() {
            let ForceKind::Contact(contact) = &force.kind else {
                columns.skip(&force.kind);
                continue;
            };
            let column = columns.next();
            let shape = [&contact.semi_axes, &contact.axes];
            for (k, (_, pose)) in self.poses.iter().enumerate() {
                let push = column.at(k);
                if dot(push, push) == 0.0 || !push.iter().all(|f| f.is_finite()) {
                    continue;
                }
                // the normal of the plane, or the direction against the force
                let normal = match &contact.against {
                    Against::Ellipsoid(_) => push,
                    against => match against.plane() {
                        Some(plane) => pose
                            .body(plane.at.on)
                            .direction(self.numbers.vector(&plane.normal)),
                        None => push,
                    },
                };
                let place = self.deepest(pose, &contact.ellipsoid, shape, normal);
                let mut numbers = vec![json!(index)];
                numbers.extend(place.map(short));
                numbers.extend(push.map(short));
                at_times[k].push(numbers.into());
            }
        }
        at_times.into()
    }

    /// The point of an ellipsoid that is farthest in the direction −n: c − Q n/√(nᵀQ n).
    fn deepest(
        &self,
        pose: &Pose,
        center: &Attachment,
        [semi_axes, axes]: [&[Number; 3]; 2],
        normal: Vec3,
    ) -> Vec3 {
        let own = bryant_rotation(self.numbers.vector(axes));
        let semi = self.numbers.vector(semi_axes);
        let body = pose.body(center.on);
        let c = pose.point(&self.numbers, center);
        let mut sum = [0.0; 3];
        let mut squared = 0.0;
        let planar = self.model.dimension == Dimension::Plane;
        for k in 0..3 {
            if planar && k == 1 {
                continue;
            }
            let axis = body.direction(std::array::from_fn(|i| own[i][k] * semi[k]));
            let along = dot(axis, normal);
            squared += along * along;
            for (sum, axis) in sum.iter_mut().zip(axis) {
                *sum += along * axis;
            }
        }
        let length = squared.sqrt().max(1e-300);
        std::array::from_fn(|i| c[i] - sum[i] / length)
    }
}

/// The columns of forces, read one after the other.
struct Columns<'a> {
    forces: &'a [Vec<f64>],
    next: usize,
}

/// The force of one contact, belt, spring or bushing, along x, y, z.
struct Column<'a>(&'a [Vec<f64>]);

impl<'a> Columns<'a> {
    fn new(model: &Model, forces: &'a [Vec<f64>]) -> Self {
        let count: usize = model.forces.iter().map(|f| lines(&f.kind)).sum();
        debug_assert!(forces.is_empty() || forces.len() == 3 * count);
        Columns { forces, next: 0 }
    }

    /// The columns of the next line.
    fn next(&mut self) -> Column<'a> {
        let first = self.next;
        self.next += 3;
        Column(self.forces.get(first..first + 3).unwrap_or(&[]))
    }

    /// Skips the columns of a force.
    fn skip(&mut self, kind: &ForceKind) {
        self.next += 3 * lines(kind);
    }
}

impl Column<'_> {
    fn at(&self, k: usize) -> Vec3 {
        std::array::from_fn(|i| {
            let column = self.0.get(i);
            column
                .and_then(|values| values.get(k))
                .copied()
                .unwrap_or(0.0)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::quaternion;
    use crate::pose::{bryant_rotation, rotation};

    #[test]
    fn a_quaternion_is_the_rotation_it_is_made_of() {
        for a in [-3.0, -1.6, -0.4, 0.0, 0.9, 2.8] {
            for b in [-1.5, 0.0, 0.7, 1.5] {
                for c in [-3.1, 0.0, 1.2, 3.0] {
                    let rows = bryant_rotation([a, b, c]);
                    let back = rotation(&quaternion(rows));
                    for (x, y) in rows.iter().flatten().zip(back.iter().flatten()) {
                        // a dozen products of numbers up to 1
                        assert!((x - y).abs() <= 32.0 * f64::EPSILON, "{rows:?} {back:?}");
                    }
                }
            }
        }
    }
}
