//! The visible parts of a model at one time, as shapes in the plane of the picture \[m\].

use super::view::View;
use crate::pose::{Numbers, Pose, Vec3, bryant_rotation, dot};
use bryant_generator::model::{
    Against, Attachment, BeltLength, Body, Contact, Element, ElementId, ForceKind, Freedom, Model,
    Number,
};

/// A point in the plane of the picture: to the right, upwards \[m\].
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
    /// Ellipsoids.
    pub ellipses: Vec<Ellipse>,
    /// Whether some of them are in no contact.
    pub some_meet_nothing: bool,
    /// Contact planes that are seen edge-on.
    pub planes: Vec<Plane>,
    /// Contact planes that are not seen edge-on: their corners.
    pub faces: Vec<[Point; 4]>,
    /// Belts.
    pub belts: Vec<Belt>,
    /// Ends of springs.
    pub springs: Vec<[Point; 2]>,
    /// Origins of both frames of bushings.
    pub bushings: Vec<[Point; 2]>,
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
    /// Unit vector to the side of the ellipsoid.
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
pub fn figures(
    model: &Model,
    parameters: &[f64],
    poses: &[(f64, Pose)],
    view: View,
) -> Vec<Figure> {
    let numbers = Numbers { model, parameters };
    let surfaces = surfaces(model, numbers, poses);
    let side = |point: Vec3| view.seen(point);
    let lengths = belt_lengths(numbers, poses);
    let figure = |(time, pose): &(f64, Pose)| {
        let mut figure = Figure {
            time: *time,
            some_meet_nothing: !model.shown.is_empty(),
            ..Figure::default()
        };
        for (index, system) in model.systems.iter().enumerate() {
            for element in 0..system.elements.len() {
                let id = ElementId {
                    system: index,
                    element,
                };
                add_element(&mut figure, numbers, pose, id, view);
            }
        }
        add_ellipses(&mut figure, numbers, pose, view);
        for surface in &surfaces {
            match surface.seen(pose, view) {
                Seen::Edge(plane) => figure.planes.push(plane),
                Seen::Face(corners) => figure.faces.push(corners),
            }
        }
        let belts = belts(model).zip(&lengths);
        figure.belts = belts
            .flat_map(|(belt, untensioned)| {
                let points = belt.points().map(|point| pose.point(&numbers, point));
                let points: Vec<Vec3> = points.collect();
                let taut = way(&points) > *untensioned;
                let segments = points.windows(2).map(|ends| Belt {
                    from: side(ends[0]),
                    to: side(ends[1]),
                    taut,
                });
                segments.collect::<Vec<_>>()
            })
            .collect();
        figure.springs = springs(model)
            .map(|spring| [&spring.from, &spring.to].map(|end| side(pose.point(&numbers, end))))
            .collect();
        figure.bushings = bushings(model)
            .map(|bushing| {
                [&bushing.from.on, &bushing.to.on].map(|end| side(pose.point(&numbers, end)))
            })
            .collect();
        figure
    };
    poses.iter().map(figure).collect()
}

fn distance([a, b]: [Vec3; 2]) -> f64 {
    let d: Vec3 = std::array::from_fn(|i| b[i] - a[i]);
    dot(d, d).sqrt()
}

/// Length of the line through these points.
fn way(points: &[Vec3]) -> f64 {
    let pairs = points.windows(2);
    pairs.map(|ends| distance([ends[0], ends[1]])).sum()
}

/// The belts of a model.
pub fn belts(model: &Model) -> impl Iterator<Item = &bryant_generator::model::Belt> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Belt(belt) => Some(&**belt),
        _ => None,
    })
}

/// The springs of a model.
pub fn springs(model: &Model) -> impl Iterator<Item = &bryant_generator::model::Spring> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Spring(spring) => Some(&**spring),
        _ => None,
    })
}

/// The bushings of a model.
pub fn bushings(model: &Model) -> impl Iterator<Item = &bryant_generator::model::Bushing> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Bushing(bushing) => Some(&**bushing),
        _ => None,
    })
}

/// An ellipsoid of a model: its centre, its semi-axes, the angles of these, its degree.
type Shape<'a> = (&'a Attachment, &'a [Number; 3], &'a [Number; 3], u32);

/// The ellipsoids of a model: those of its contacts, those of its airbags, then those that meet nothing.
pub fn ellipsoids(model: &Model) -> impl Iterator<Item = Shape<'_>> {
    let contacts = contacts(model).flat_map(|contact| {
        let first = (
            &contact.ellipsoid,
            &contact.semi_axes,
            &contact.axes,
            contact.degree,
        );
        let second = match &contact.against {
            Against::Ellipsoid(second) => {
                Some((&second.center, &second.semi_axes, &second.axes, 2))
            }
            Against::Plane(_) => None,
        };
        std::iter::once(first).chain(second)
    });
    let airbags = model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Airbag(airbag) => Some(airbag),
        _ => None,
    });
    let bags = airbags.flat_map(|airbag| airbag.ellipsoids());
    let bags = bags.map(|bag| (&bag.center, &bag.semi_axes, &bag.axes, 2));
    let shown = model.shown.iter().map(|shown| {
        let round = &shown.round;
        (&round.center, &round.semi_axes, &round.axes, shown.degree)
    });
    contacts.chain(bags).chain(shown)
}

/// The contacts of a model.
pub fn contacts(model: &Model) -> impl Iterator<Item = &Contact> {
    model.forces.iter().filter_map(|force| match &force.kind {
        ForceKind::Contact(contact) => Some(&**contact),
        _ => None,
    })
}

/// Untensioned lengths of the belts, from their positions in the first pose \[m\].
pub fn belt_lengths(numbers: Numbers<'_>, poses: &[(f64, Pose)]) -> Vec<f64> {
    let Some((_, start)) = poses.first() else {
        return Vec::new();
    };
    let length = |belt: &bryant_generator::model::Belt| {
        let points = belt.points().map(|point| start.point(&numbers, point));
        let initial = way(&points.collect::<Vec<_>>());
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

/// Lines from the joint of an element to the joints that it carries; an element that carries none is drawn to its end.
fn add_element(figure: &mut Figure, numbers: Numbers<'_>, pose: &Pose, id: ElementId, view: View) {
    let side = |point: Vec3| view.seen(point);
    let elements = &numbers.model.systems[id.system].elements;
    let element = &elements[id.element];
    let frame = pose.frame(id);
    let origin = side(frame.origin);
    let mut bone = |local: Vec3| {
        let end = side(frame.point(local));
        figure.bones.push((id.system, origin, end));
    };
    let children = elements.iter().enumerate();
    let children = children.filter(|(_, child)| child.parent == Some(id.element));
    let mut tip = true;
    // from the places of joints on it to the parts that have slid away from them
    let mut slides = Vec::new();
    for (index, child) in children {
        let at = numbers.vector(&child.at);
        let slid = pose.frame(ElementId {
            element: index,
            ..id
        });
        if child.joint.freedoms().iter().any(Freedom::slides) {
            slides.push((id.system, side(frame.point(at)), side(slid.origin)));
        }
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
    figure.bones.extend(slides);
    figure.joints.push((id.system, origin));
}

/// Ends of an element that carries no other element, in its local frame: the ends of the uniform rod with the same mass and the same
/// largest moment about the joint; for an element that turns about its centre of gravity, the ends along its axes.
pub fn ends(numbers: Numbers<'_>, element: &Element) -> Vec<Vec3> {
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

/// Draws every ellipsoid once, even if it touches several planes.
fn add_ellipses(figure: &mut Figure, numbers: Numbers<'_>, pose: &Pose, view: View) {
    for (center, semi_axes, axes, _) in ellipsoids(numbers.model) {
        let ellipse = outline(numbers, pose, center, [semi_axes, axes], view);
        if !figure.ellipses.contains(&ellipse) {
            figure.ellipses.push(ellipse);
        }
    }
}

/// Outline of an ellipsoid with axes B and semi-axes a: with Q = B diag(a²) Bᵀ, the outline is the ellipse of the block of Q in the
/// directions of the picture.
fn outline(
    numbers: Numbers<'_>,
    pose: &Pose,
    center: &Attachment,
    [semi_axes, axes]: [&[Number; 3]; 2],
    view: View,
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
    let columns = columns.map(|column| view.seen(column));
    let entry =
        |i: usize, j: usize| -> f64 { seen.iter().map(|&k| columns[k][i] * columns[k][j]).sum() };
    let (xx, xz, zz) = (entry(0, 0), entry(0, 1), entry(1, 1));
    let (mean, difference) = ((xx + zz) / 2.0, (xx - zz) / 2.0);
    let radius = libm::hypot(difference, xz);
    Ellipse {
        system: system_of(center.on),
        centre: view.seen(pose.point(&numbers, center)),
        semi_axes: [(mean + radius).sqrt(), (mean - radius).max(0.0).sqrt()],
        angle: 0.5 * libm::atan2(xz, difference),
    }
}

fn system_of(body: Body) -> Option<usize> {
    match body {
        Body::Frame | Body::Vehicle(_) => None,
        Body::Element(id) => Some(id.system),
    }
}

/// A plane with its extent; of a plane without end, the piece near which the ellipsoids come during the motion.
pub struct Surface {
    /// The body that carries it.
    pub on: Body,
    /// A point, local frame.
    point: Vec3,
    /// Normal to the side of the ellipsoids, local frame.
    pub normal: Vec3,
    /// Directions in the plane, local frame; the second is not used in a planar model.
    along: [Vec3; 2],
    /// Extent of the piece from the point, along these directions.
    reach: [[f64; 2]; 2],
}

/// The appearance of a plane.
enum Seen {
    /// Its edge.
    Edge(Plane),
    /// Its corners.
    Face([Point; 4]),
}

/// A plane is seen edge-on if its normal leaves the plane of the picture by at most this sine.
const EDGE_ON: f64 = 0.02;

/// The planes of a model, each once.
pub fn surfaces(model: &Model, numbers: Numbers<'_>, poses: &[(f64, Pose)]) -> Vec<Surface> {
    let planar = model.dimension == bryant_generator::model::Dimension::Plane;
    let mut surfaces: Vec<Surface> = Vec::new();
    for contact in contacts(model) {
        let Some(plane) = contact.against.plane() else {
            continue;
        };
        let point = numbers.vector(&plane.at.at);
        let Some(normal) = unit(numbers.vector(&plane.normal)) else {
            continue;
        };
        let along = directions(normal, numbers.vector(&plane.tangent));
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let largest = numbers.vector(&contact.semi_axes);
        let size = 1.15
            * if planar {
                largest[0].max(largest[2])
            } else {
                largest.into_iter().fold(0.0, f64::max)
            };
        for (_, pose) in poses {
            let body = pose.body(plane.at.on);
            let centre = pose.point(&numbers, &contact.ellipsoid);
            let from: Vec3 = std::array::from_fn(|i| centre[i] - body.point(point)[i]);
            for (reach, along) in reach.iter_mut().zip(along) {
                let offset = dot(from, body.direction(along));
                *reach = [reach[0].min(offset - size), reach[1].max(offset + size)];
            }
        }
        if let Some(extent) = &plane.extent {
            for (reach, half) in reach.iter_mut().zip(&extent.half_lengths) {
                let half = half.value(numbers.parameters);
                *reach = [-half, half];
            }
        }
        let same = |s: &&mut Surface| {
            let extends = plane.extent.is_none() || s.reach == reach;
            s.on == plane.at.on && s.point == point && s.normal == normal && extends
        };
        match surfaces.iter_mut().find(same) {
            Some(s) => {
                for (known, new) in s.reach.iter_mut().zip(reach) {
                    *known = [known[0].min(new[0]), known[1].max(new[1])];
                }
            }
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

/// The unit vector in this direction; `None` if there is no direction.
fn unit(vector: Vec3) -> Option<Vec3> {
    let length = dot(vector, vector).sqrt();
    (length > 1e-12).then(|| vector.map(|a| a / length))
}

/// Two directions in a plane: the tangent, or without a tangent one in x–z, and normal × this.
fn directions(normal: Vec3, tangent: Vec3) -> [Vec3; 2] {
    let within = |vector: Vec3| {
        let out = dot(vector, normal);
        unit(std::array::from_fn(|i| vector[i] - out * normal[i]))
    };
    // a plane whose normal is along y contains x and z
    let first = within(tangent)
        .or_else(|| unit([-normal[2], 0.0, normal[0]]))
        .unwrap_or([1.0, 0.0, 0.0]);
    let second = [
        normal[1] * first[2] - normal[2] * first[1],
        normal[2] * first[0] - normal[0] * first[2],
        normal[0] * first[1] - normal[1] * first[0],
    ];
    [first, second]
}

impl Surface {
    /// The corners of the piece, in order around it, local frame.
    pub fn corners(&self) -> [Vec3; 4] {
        let corner = |a: f64, b: f64| {
            std::array::from_fn(|i| self.point[i] + a * self.along[0][i] + b * self.along[1][i])
        };
        let [[a, b], [c, d]] = self.reach;
        [corner(a, c), corner(b, c), corner(b, d), corner(a, d)]
    }

    /// The piece in one pose.
    fn seen(&self, pose: &Pose, view: View) -> Seen {
        let body = pose.body(self.on);
        let corners = self.corners().map(|local| view.seen(body.point(local)));
        let normal = view.seen(body.direction(self.normal));
        let length = libm::hypot(normal[0], normal[1]);
        if length < (1.0 - EDGE_ON * EDGE_ON).sqrt() {
            return Seen::Face(corners);
        }
        let normal = normal.map(|n| n / length);
        // the corners are on one line: its ends
        let place = |corner: &Point| corner[1] * normal[0] - corner[0] * normal[1];
        let ends = |from: Point, to: &Point| match place(to) > place(&from) {
            true => [from, *to],
            false => [*to, from],
        };
        let [mut from, mut to] = ends(corners[0], &corners[1]);
        for corner in &corners[2..] {
            from = ends(from, corner)[0];
            to = ends(to, corner)[1];
        }
        Seen::Edge(Plane { from, to, normal })
    }
}
