//! When a contact begins: the gap of its surfaces, and a bound of the speed of the gap
//! ([`force::onset`](crate::force::onset)).
//!
//! | contact | gap | speed |
//! |---|---|---|
//! | ellipsoid and plane | −δ | \|n·v\| + \|ω\| r |
//! | plane with edges | the largest of −δ and \|ξ_i\| − e_i | the largest of the speeds of these, \|t_i·v\| + \|ω\| (a + a²/b) for ξ_i |
//! | two ellipsoids | a lower bound of their distance | the smaller of \|v\| + \|ω\| r₁, and \|ċ₂ − ċ₁\| + \|ω₁\| r₁ + \|ω₂\| r₂ |
//!
//! δ is the penetration of a plane with the normal n; ξ_i is the coordinate of the deepest point along the edge
//! direction t_i, and e_i the half length. v is the velocity of the (first) ellipsoid's centre relative to the other
//! body's material there, ω the relative angular velocity, ċ the velocity of a centre; a and b are the largest and the
//! smallest semi-axis. r is the largest change of an ellipsoid's reach per angle: a − b. If the degree of the ellipsoid
//! is not 2, r is the distance R of its farthest point; its deepest point may then jump, and 2R replaces a + a²/b. For
//! a sphere both are 0.

use super::{Against, Contact};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::force::onset::{Onset, absolute, size};
use crate::model::{Dimension, Ellipsoid, Number};
use crate::motion::numbers::{number, vector};
use crate::motion::{ElementMotion, Motion, Point};

/// Bounds on the motion of an ellipsoid's surface points as it turns, in m per rad: constants, or expressions of
/// parameters.
struct Sizes<'g> {
    /// Largest change of the reach (the extent in a direction) per angle.
    reach: Expr<'g>,
    /// Largest displacement of the deepest point relative to the centre, per angle.
    deepest: Expr<'g>,
}

impl<'g> Sizes<'g> {
    fn of(graph: &'g Graph, dimension: Dimension, semi_axes: &[Number; 3], degree: u32) -> Self {
        let a = vector(graph, semi_axes).0;
        let used: &[usize] = match dimension {
            Dimension::Plane => &[0, 2],
            Dimension::Space => &[0, 1, 2],
        };
        let zero = graph.constant(0.0);
        if degree != 2 {
            let squares = used.iter().fold(zero, |sum, &i| sum + a[i].squared());
            let farthest = squares.sqrt();
            return Sizes {
                reach: farthest,
                deepest: 2.0 * farthest,
            };
        }
        let round = used.iter().all(|&i| a[i].id() == a[0].id());
        if round {
            return Sizes {
                reach: zero,
                deepest: zero,
            };
        }
        let largest = used[1..].iter().fold(a[0], |largest, &i| largest.max(a[i]));
        let least = used[1..].iter().fold(a[0], |least, &i| least.min(a[i]));
        Sizes {
            reach: largest - least,
            deepest: largest + largest.squared() / least,
        }
    }
}

/// The bodies and places of a contact, kept until the onsets are made.
pub struct Pair<'g> {
    graph: &'g Graph,
    dimension: Dimension,
    contact: Contact,
    /// The motion of the ellipsoid's body, and of the body of the other surface.
    bodies: [ElementMotion<'g>; 2],
    /// The centre of the ellipsoid, and the centre or point of the other surface.
    places: [Point<'g>; 2],
}

impl<'g> Pair<'g> {
    /// The bodies and places of a contact.
    pub fn of(
        graph: &'g Graph,
        dimension: Dimension,
        motion: &Motion<'g>,
        contact: &Contact,
    ) -> Self {
        let places = [&contact.ellipsoid.center, contact.against.place()];
        Pair {
            graph,
            dimension,
            contact: contact.clone(),
            bodies: places.map(|place| motion.body(place.on).clone()),
            places: places.map(|place| motion.attachment(graph, place)),
        }
    }

    /// The largest rate of change of the distance of the two bodies \[m/s\]; for a plane the distance along its
    /// `normal`, without regard to its edges.
    pub fn closing(&self, normal: Vec3<'g>) -> Expr<'g> {
        match &self.contact.against {
            Against::Ellipsoid(second) => self.towards_ellipsoid(second),
            Against::Plane(_) => {
                let [velocity, omega] = self.relative();
                absolute(normal.dot(velocity)) + size(omega) * self.sizes().reach
            }
        }
    }

    /// The onset of a contact. `gap` is a lower bound of the distance of the bodies and `normal` the normal of a plane.
    /// `tangents` are the directions of the plane's edges and `places` the coordinates of the deepest point along them.
    pub fn touches(
        &self,
        gap: Expr<'g>,
        normal: Vec3<'g>,
        tangents: &[Vec3<'g>],
        places: &[Expr<'g>],
    ) -> Onset<'g> {
        let speed = self.closing(normal);
        let mut onset = Onset { gap, speed };
        if let Against::Plane(plane) = &self.contact.against {
            let [velocity, omega] = self.relative();
            let turning = size(omega);
            let halves = plane.extent.iter().flat_map(|extent| &extent.half_lengths);
            for ((tangent, place), half) in tangents.iter().zip(places).zip(halves) {
                let beside = absolute(*place) - number(self.graph, half);
                let along = absolute(tangent.dot(velocity)) + turning * self.sizes().deepest;
                onset.gap = onset.gap.max(beside);
                onset.speed = onset.speed.max(along);
            }
        }
        onset
    }

    fn sizes(&self) -> Sizes<'g> {
        let semi_axes = &self.contact.ellipsoid.semi_axes;
        Sizes::of(self.graph, self.dimension, semi_axes, self.contact.degree)
    }

    /// The velocity of the ellipsoid's centre and its angular velocity, relative to the second body.
    fn relative(&self) -> [Vec3<'g>; 2] {
        let ([first, second], [centre, _]) = (&self.bodies, &self.places);
        let there = second.velocity_at(centre.position - second.position);
        [centre.velocity - there, first.omega - second.omega]
    }

    fn towards_ellipsoid(&self, second: &Ellipsoid) -> Expr<'g> {
        let mine = self.sizes().reach;
        let theirs = Sizes::of(self.graph, self.dimension, &second.semi_axes, 2).reach;
        let [velocity, omega] = self.relative();
        let with_second = size(velocity) + size(omega) * mine;
        let ([first, other], [a, b]) = (&self.bodies, &self.places);
        let turning = size(first.omega) * mine + size(other.omega) * theirs;
        with_second.min(size(b.velocity - a.velocity) + turning)
    }
}
