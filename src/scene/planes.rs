//! Planes with their extents; of a plane without end, the piece near which the ellipsoids come during the motion.

use super::{Bodies, Plane, Scene, from_to, length};
use crate::pose::{Numbers, Vec3, cross, dot};
use bryant_generator::model;
use bryant_generator::model::Round;

/// A plane whose piece may still grow.
#[derive(PartialEq)]
struct Piece {
    name: String,
    body: Option<usize>,
    /// A point, local frame.
    point: Vec3,
    normal: Vec3,
    /// Directions in the plane, local frame; the second is not used in a planar model.
    along: [Vec3; 2],
    /// Extent of the piece from the point, along these directions.
    reach: [[f64; 2]; 2],
}

/// The planes of a model, each once.
#[derive(Default)]
pub struct Planes(Vec<Piece>);

impl Planes {
    /// Adds a plane, and what meets it, of a force of this name.
    pub fn add(
        &mut self,
        name: &str,
        (plane, round): (&model::Plane, Option<Round<'_>>),
        bodies: &Bodies<'_>,
        numbers: Numbers<'_>,
        scene: &Scene,
    ) {
        let Some(normal) = unit(numbers.vector(&plane.normal)) else {
            return;
        };
        let body = bodies.index(plane.at.on);
        let point = numbers.vector(&plane.at.at);
        let along = directions(normal, numbers.vector(&plane.tangent));
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        if let Some(round) = round {
            let semi = numbers.vector(round.semi_axes);
            let used: &[usize] = if scene.planar { &[0, 2] } else { &[0, 1, 2] };
            let size = 1.15 * used.iter().fold(0.0, |most, i| semi[*i].max(most));
            for k in 0..scene.times.len() {
                let frame = scene.frame(k, body);
                let carrier = scene.frame(k, bodies.index(round.center.on));
                let centre = carrier.point(numbers.vector(&round.center.at));
                let from = from_to(frame.point(point), centre);
                for (reach, along) in reach.iter_mut().zip(along) {
                    let offset = dot(from, frame.direction(along));
                    *reach = [reach[0].min(offset - size), reach[1].max(offset + size)];
                }
            }
        }
        if let Some(extent) = &plane.extent {
            for (reach, half) in reach.iter_mut().zip(&extent.half_lengths) {
                let half = numbers.value(half);
                *reach = [-half, half];
            }
        }
        // a plane without end that nothing meets
        if !reach[0][0].is_finite() {
            return;
        }
        // in the plane it has an extent along it alone
        if !reach[1][0].is_finite() {
            reach[1] = reach[0];
        }
        let same = |known: &&mut Piece| {
            let extends = plane.extent.is_none() || known.reach == reach;
            let place = (known.body, known.point, known.normal);
            place == (body, point, normal) && extends
        };
        match self.0.iter_mut().find(same) {
            Some(known) => {
                for (known, new) in known.reach.iter_mut().zip(reach) {
                    *known = [known[0].min(new[0]), known[1].max(new[1])];
                }
            }
            None => self.0.push(Piece {
                name: name.to_owned(),
                body,
                point,
                normal,
                along,
                reach,
            }),
        }
    }

    /// All of them.
    pub fn finish(self) -> Vec<Plane> {
        self.0.into_iter().map(Piece::plane).collect()
    }
}

impl Piece {
    fn plane(self) -> Plane {
        let [first, second] = self.along;
        let corner =
            |a: f64, b: f64| std::array::from_fn(|i| self.point[i] + a * first[i] + b * second[i]);
        let [[a, b], [c, d]] = self.reach;
        Plane {
            name: self.name,
            body: self.body,
            corners: [corner(a, c), corner(b, c), corner(b, d), corner(a, d)],
            normal: self.normal,
        }
    }
}

/// The unit vector in this direction; `None` if there is no direction.
fn unit(vector: Vec3) -> Option<Vec3> {
    let length = length(vector);
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
    [first, cross(normal, first)]
}
