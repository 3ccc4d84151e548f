//! The touch of two ellipsoids: along the direction n in which they overlap least.
//!
//! δ(n) = h₁(n) + h₂(n) − n·(c₂ − c₁), smallest over unit vectors n (`force::approach::approach`; two spheres overlap least
//! along the line of their centres). The deepest points c₁ + u₁ and c₂ − u₂, u = Q n/h, then lie δ n apart, and forces act half
//! way between them. As δ is smallest, its rate knows nothing of that of n: δ̇ = n·(v₁ − v₂), at either point and between.

use super::{Motion, Touch};
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Function, Graph};
use crate::formalism::kinematics::constant_rotation;
use crate::formalism::numbers::vector;
use crate::model::{Attachment, Contact, Dimension, Ellipsoid, Number};

/// Squared distance of two centres below which their line is taken at this distance \[m²\].
const SMALLEST_SQUARED_DISTANCE: f64 = 1e-20;

/// An ellipsoid in absolute axes.
struct Body<'g> {
    centre: Vec3<'g>,
    /// From the joint of its body.
    offset: Vec3<'g>,
    /// Of a sphere.
    radius: Option<Expr<'g>>,
    /// Q = R diag(a²) Rᵀ by xx, yy, zz, yz, xz, xy \[m²\].
    quadric: [Expr<'g>; 6],
}

/// The touch of two ellipsoids.
pub fn on_ellipsoid<'g>(
    graph: &'g Graph,
    dimension: Dimension,
    motion: &Motion<'g>,
    contact: &Contact,
    second: &Ellipsoid,
) -> Touch<'g> {
    let bodies = [&contact.ellipsoid, &second.center].map(|place| motion.body(place.on));
    let first = Body::of(
        graph,
        dimension,
        motion,
        &contact.ellipsoid,
        [&contact.semi_axes, &contact.axes],
    );
    let other = Body::of(
        graph,
        dimension,
        motion,
        &second.center,
        [&second.semi_axes, &second.axes],
    );
    let between = other.centre - first.centre;
    let (direction, penetration) = match (first.radius, other.radius) {
        (Some(a), Some(b)) => {
            let smallest = graph.constant(SMALLEST_SQUARED_DISTANCE);
            let distance = between.squared().max(smallest).sqrt();
            (distance.recip() * between, a + b - distance)
        }
        _ => {
            let arguments = [&first.quadric[..], &other.quadric, &between.0].concat();
            let part = |part: u8| graph.call(Function::Approach(part), &arguments);
            let y = match dimension {
                Dimension::Plane => graph.constant(0.0),
                Dimension::Space => part(1),
            };
            (Vec3([part(0), y, part(2)]), part(3))
        }
    };
    let from_centre = first.support(direction) - ((0.5 * penetration) * direction);
    let offset = first.offset + from_centre;
    let point = first.centre + from_centre;
    let offset_on_second = point - bodies[1].position;
    let velocity = bodies[0].velocity_at(offset) - bodies[1].velocity_at(offset_on_second);
    let tangents = match dimension {
        Dimension::Space if contact.bristle.is_some() => {
            (0..3).map(|j| bodies[1].rotation.column(j)).collect()
        }
        _ => Vec::new(),
    };
    Touch {
        penetration,
        normal: -direction,
        offset,
        offset_on_second,
        velocity,
        approach: direction.dot(velocity),
        centre: first.offset,
        centre_on_second: first.centre - bodies[1].position,
        place: Vec::new(),
        moving: Vec::new(),
        flats: Vec::new(),
        tangents,
    }
}

impl<'g> Body<'g> {
    fn of(
        graph: &'g Graph,
        dimension: Dimension,
        motion: &Motion<'g>,
        center: &Attachment,
        [semi_axes, axes]: [&[Number; 3]; 2],
    ) -> Self {
        let place = motion.attachment(graph, center);
        let a = vector(graph, semi_axes).0;
        let used: &[usize] = match dimension {
            Dimension::Plane => &[0, 2],
            Dimension::Space => &[0, 1, 2],
        };
        let zero = graph.constant(0.0);
        let round = used.iter().all(|&i| a[i].id() == a[0].id());
        let mut quadric = if round {
            let square = a[0].squared();
            [square, square, square, zero, zero, zero]
        } else {
            let axes = constant_rotation(graph, axes);
            let stretched = Mat3(
                axes.0
                    .map(|row| std::array::from_fn(|k| row[k] * a[k].squared())),
            );
            let local = stretched.product(&axes.transposed());
            let body = &motion.body(center.on).rotation;
            let turned = body.product(&local);
            let entry = |i: usize, j: usize| Vec3(turned.0[i]).dot(Vec3(body.0[j]));
            [
                entry(0, 0),
                entry(1, 1),
                entry(2, 2),
                entry(1, 2),
                entry(0, 2),
                entry(0, 1),
            ]
        };
        if dimension == Dimension::Plane {
            // a cylinder long enough that nothing wants to leave the plane
            quadric[1] = 2.0 * (quadric[0] + quadric[2]);
            (quadric[3], quadric[5]) = (zero, zero);
        }
        Body {
            centre: place.position,
            offset: place.offset,
            radius: round.then_some(a[0]),
            quadric,
        }
    }

    /// From the centre to the point that is furthest in a direction.
    fn support(&self, direction: Vec3<'g>) -> Vec3<'g> {
        if let Some(radius) = self.radius {
            return radius * direction;
        }
        let [xx, yy, zz, yz, xz, xy] = self.quadric;
        let stretched = Mat3([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).times(direction);
        direction.dot(stretched).sqrt().recip() * stretched
    }
}
