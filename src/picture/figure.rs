//! What is to be seen of a model at one time, as shapes in the x–z plane \[m\].

use crate::pose::{Numbers, Pose, Vec3, bryant_rotation, dot};
use bryant_generator::model::{
    Against, Attachment, BeltLength, Body, Contact, Element, ElementId, ForceKind, Model, Number,
};

/// A point of the plane of the picture: x, z \[m\].
pub type Point = [f64; 2];

/// One stick figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figure {
    /// \[s\]
    pub time: f64,
    /// Elements, as (system, from, to).
    pub bones: Vec<(usize, Point, Point)>,
    /// Joints, as (system, place).
    pub joints: Vec<(usize, Point)>,
    /// Centres of gravity of elements that carry no other.
    pub masses: Vec<(usize, Point)>,
    /// Contact ellipsoids.
    pub ellipses: Vec<Ellipse>,
    /// Contact planes.
    pub planes: Vec<Plane>,
    /// Belts.
    pub belts: Vec<Belt>,
}

/// Outline of an ellipsoid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// System of the body that carries it; `None` for the frame.
    pub system: Option<usize>,
    /// Centre.
    pub centre: Point,
    /// Semi-axes.
    pub semi_axes: [f64; 2],
    /// Angle of the first semi-axis from x towards z \[rad\].
    pub angle: f64,
}

/// A plane, seen as a piece of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// One end.
    pub from: Point,
    /// The other end.
    pub to: Point,
    /// Unit vector to the side where the ellipsoid belongs.
    pub normal: Point,
}

/// A belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Belt {
    /// One end.
    pub from: Point,
    /// The other end.
    pub to: Point,
    /// False where it is slack.
    pub taut: bool,
}

/// The figures of several poses of one motion.
pub fn figures(model: &Model, parameters: &[f64], poses: &[(f64, Pose)]) -> Vec<Figure> {
    let numbers = Numbers { model, parameters };
    let surfaces = surfaces(model, numbers, poses);
    let lengths = belt_lengths(numbers, poses);
    let figure = |(time, pose): &(f64, Pose)| {
        let mut figure = Figure {
            time: *time,
            ..Figure::default()
        };
        for (index, system) in model.systems.iter().enumerate() {
            for element in 0..system.elements.len() {
                let id = ElementId {
                    system: index,
                    element,
                };
                add_element(&mut figure, numbers, pose, id);
            }
        }
        add_ellipses(&mut figure, numbers, pose);
        figure.planes = surfaces.iter().filter_map(|s| s.seen(pose)).collect();
        let belts = belts(model).zip(&lengths);
        figure.belts = belts
            .map(|(belt, untensioned)| {
                let ends = [&belt.from, &belt.to].map(|end| pose.point(&numbers, end));
                Belt {
                    from: side(ends[0]),
                    to: side(ends[1]),
                    taut: distance(ends) > *untensioned,
                }
            })
            .collect();
        figure
    };
    poses.iter().map(figure).collect()
}

/// Seen from the side.
fn side(point: Vec3) -> Point {
    [point[0], point[2]]
}

fn distance([a, b]: [Vec3; 2]) -> f64 {
    let d: Vec3 = std::array::from_fn(|i| b[i] - a[i]);
    dot(d, d).sqrt()
}

fn belts(model: &Model) -> impl Iterator<Item = &bryant_generator::model::Belt> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Belt(belt) => Some(&**belt),
        _ => None,
    })
}

fn contacts(model: &Model) -> impl Iterator<Item = &Contact> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Contact(contact) => Some(&**contact),
        _ => None,
    })
}

/// Untensioned lengths of the belts, from where they are in the first pose \[m\].
fn belt_lengths(numbers: Numbers<'_>, poses: &[(f64, Pose)]) -> Vec<f64> {
    let Some((_, start)) = poses.first() else {
        return Vec::new();
    };
    let length = |belt: &bryant_generator::model::Belt| {
        let initial = distance([&belt.from, &belt.to].map(|end| start.point(&numbers, end)));
        let value = |number: &Number| number.value(numbers.parameters);
        match &belt.length {
            BeltLength::Given(length) => value(length),
            BeltLength::Slack(slack) => initial + value(slack),
            BeltLength::Pretension(force) => {
                let curve = &numbers.model.curves[belt.force.curve];
                let ordinate = value(force) / value(&belt.force.times);
                let elongation = value(&belt.force.stretch) * curve.inverse(ordinate);
                initial / (1.0 + elongation)
            }
        }
    };
    belts(numbers.model).map(length).collect()
}

/// Lines from the joint of an element to the joints that it carries; one that carries none is drawn to its end.
fn add_element(figure: &mut Figure, numbers: Numbers<'_>, pose: &Pose, id: ElementId) {
    let elements = &numbers.model.systems[id.system].elements;
    let element = &elements[id.element];
    let frame = pose.frame(id);
    let origin = side(frame.origin);
    let mut bone = |local: Vec3| {
        let end = side(frame.point(local));
        figure.bones.push((id.system, origin, end));
    };
    let children = elements.iter().filter(|c| c.parent == Some(id.element));
    let mut tip = true;
    for child in children {
        let at = numbers.vector(&child.at);
        if dot(at, at) > 0.0 {
            bone(at);
            tip = false;
        }
    }
    if tip {
        for end in ends(numbers, element) {
            bone(end);
        }
        let centre = side(frame.point(numbers.vector(&element.cg)));
        figure.masses.push((id.system, centre));
    }
    figure.joints.push((id.system, origin));
}

/// Ends of an element that carries no other, local frame: that of the uniform rod with its mass and largest moment about
/// the joint; of an element that turns about its centre of gravity, those along its axes.
fn ends(numbers: Numbers<'_>, element: &Element) -> Vec<Vec3> {
    let value = |number: &Number| number.value(numbers.parameters);
    let cg = numbers.vector(&element.cg);
    let moments = numbers.vector(&element.inertia);
    let mass = value(&element.mass);
    let to_cg = dot(cg, cg).sqrt();
    let planar = numbers.model.dimension == bryant_generator::model::Dimension::Plane;
    let largest = if planar {
        moments[1]
    } else {
        moments.into_iter().fold(0.0, f64::max)
    };
    // A uniform rod of half-length h has I = m h²/3.
    let half = (3.0 * largest / mass).max(0.0).sqrt();
    if to_cg > 0.05 * half {
        let factor = 1.0 + half.min(to_cg) / to_cg;
        return vec![cg.map(|c| c * factor)];
    }
    let axes = bryant_rotation(numbers.vector(&element.axes));
    let along =
        |axis: usize, length: f64| -> Vec3 { std::array::from_fn(|i| axes[i][axis] * length) };
    if planar {
        return vec![along(0, half), along(2, half / 2.0)];
    }
    let [a, b, c] = moments;
    // Semi-axes of the homogeneous ellipsoid: a² = 5 (I_y + I_z − I_x) / 2m.
    let squares = [b + c - a, a + c - b, a + b - c];
    let semi = squares.map(|s| (2.5 * s / mass).max(0.0).sqrt());
    (0..3).map(|axis| along(axis, semi[axis])).collect()
}

/// Every ellipsoid once, even where it touches several planes.
fn add_ellipses(figure: &mut Figure, numbers: Numbers<'_>, pose: &Pose) {
    for contact in contacts(numbers.model) {
        let mut ellipses = vec![ellipse(numbers, pose, contact)];
        if let Against::Ellipsoid(second) = &contact.against {
            let shape = [&second.semi_axes, &second.axes];
            ellipses.push(outline(numbers, pose, &second.center, shape));
        }
        for ellipse in ellipses {
            if !figure.ellipses.contains(&ellipse) {
                figure.ellipses.push(ellipse);
            }
        }
    }
}

/// Outline of the first ellipsoid of a contact.
fn ellipse(numbers: Numbers<'_>, pose: &Pose, contact: &Contact) -> Ellipse {
    let shape = [&contact.semi_axes, &contact.axes];
    outline(numbers, pose, &contact.ellipsoid, shape)
}

/// Outline of an ellipsoid with axes B and semi-axes a: with Q = B diag(a²) Bᵀ, seen from the side it is the ellipse of
/// the block of Q in x and z.
fn outline(
    numbers: Numbers<'_>,
    pose: &Pose,
    center: &Attachment,
    [semi_axes, axes]: [&[Number; 3]; 2],
) -> Ellipse {
    let body = pose.body(center.on);
    let own = bryant_rotation(numbers.vector(axes));
    let semi = numbers.vector(semi_axes);
    let columns: [Vec3; 3] = std::array::from_fn(|k| {
        let axis: Vec3 = std::array::from_fn(|i| own[i][k] * semi[k]);
        body.direction(axis)
    });
    let planar = numbers.model.dimension == bryant_generator::model::Dimension::Plane;
    let seen: &[usize] = if planar { &[0, 2] } else { &[0, 1, 2] };
    let entry =
        |i: usize, j: usize| -> f64 { seen.iter().map(|&k| columns[k][i] * columns[k][j]).sum() };
    let (xx, xz, zz) = (entry(0, 0), entry(0, 2), entry(2, 2));
    let (mean, difference) = ((xx + zz) / 2.0, (xx - zz) / 2.0);
    let radius = difference.hypot(xz);
    Ellipse {
        system: system_of(center.on),
        centre: side(pose.point(&numbers, center)),
        semi_axes: [(mean + radius).sqrt(), (mean - radius).max(0.0).sqrt()],
        angle: 0.5 * xz.atan2(difference),
    }
}

fn system_of(body: Body) -> Option<usize> {
    match body {
        Body::Frame | Body::Vehicle(_) => None,
        Body::Element(id) => Some(id.system),
    }
}

/// A plane with the piece of it that the ellipsoids come near during the motion.
struct Surface {
    on: Body,
    /// A point, local frame.
    point: Vec3,
    /// Local frame.
    normal: Vec3,
    /// In the direction of the plane, local frame; `None` where the plane is seen face on.
    along: Vec3,
    /// How far the piece reaches from the point, along that direction.
    reach: [f64; 2],
}

fn surfaces(model: &Model, numbers: Numbers<'_>, poses: &[(f64, Pose)]) -> Vec<Surface> {
    let mut surfaces: Vec<Surface> = Vec::new();
    for contact in contacts(model) {
        let Some(plane) = contact.against.plane() else {
            continue;
        };
        let (point, normal) = (numbers.vector(&plane.at.at), numbers.vector(&plane.normal));
        // The line of the plane in the local x–z plane, its normal on the left of it seen from −y.
        let along = [-normal[2], 0.0, normal[0]];
        let length = dot(along, along).sqrt();
        if length < 0.2 {
            continue;
        }
        let along = along.map(|a| a / length);
        let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
        for (_, pose) in poses {
            let body = pose.body(plane.at.on);
            let centre = pose.point(&numbers, &contact.ellipsoid);
            let from: Vec3 = std::array::from_fn(|i| centre[i] - body.point(point)[i]);
            let offset = dot(from, body.direction(along));
            let size = 1.15 * ellipse(numbers, pose, contact).semi_axes[0];
            reach = [reach[0].min(offset - size), reach[1].max(offset + size)];
        }
        let same = |s: &&mut Surface| s.on == plane.at.on && s.point == point && s.normal == normal;
        match surfaces.iter_mut().find(same) {
            Some(s) => s.reach = [s.reach[0].min(reach[0]), s.reach[1].max(reach[1])],
            None => surfaces.push(Surface {
                on: plane.at.on,
                point,
                normal,
                along,
                reach,
            }),
        }
    }
    surfaces
}

impl Surface {
    /// The piece at one pose; `None` where it is seen nearly face on.
    fn seen(&self, pose: &Pose) -> Option<Plane> {
        let body = pose.body(self.on);
        let end = |reach: f64| {
            let local = std::array::from_fn(|i| self.point[i] + reach * self.along[i]);
            side(body.point(local))
        };
        let [x, z] = side(body.direction(self.normal));
        let length = x.hypot(z);
        (length > 0.2).then(|| Plane {
            from: end(self.reach[0]),
            to: end(self.reach[1]),
            normal: [x / length, z / length],
        })
    }
}
