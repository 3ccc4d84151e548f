//! The touch of two ellipsoids: in the direction n in which they overlap least.
//!
//! δ is the smallest value of δ(n) = h₁(n) + h₂(n) − n·(c₂ − c₁) over unit vectors n (`force::approach`; for two
//! spheres, n is along the line of their centres). Forces need δ only while the bodies touch, distances and kinks
//! always. The deepest points c₁ + u₁ and c₂ − u₂, u = Q n/h, lie δ n apart, and forces act half-way between them. As δ
//! is a minimum, its rate does not depend on that of n: δ̇ = n·(v₁ − v₂), taken at either point or between them.

use super::Touch;
use crate::expression::choose;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{ApproachCall, Expr, Function, Graph};
use crate::law::contact::check::Contact;
use crate::model::{Attachment, Dimension, Ellipsoid, Number};
use crate::motion::Motion;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::vector;

/// Least squared distance of two centres \[m²\]. If they are closer, the line between them is divided by this distance.
const SMALLEST_SQUARED_DISTANCE: f64 = 1e-20;

/// An ellipsoid in absolute axes.
struct Body<'g> {
    centre: Vec3<'g>,
    /// Vector from the joint of the body to the centre.
    offset: Vec3<'g>,
    /// Radius, if the ellipsoid is a sphere.
    radius: Option<Expr<'g>>,
    /// Entries xx, yy, zz, yz, xz, xy of Q = R diag(a²) Rᵀ \[m²\].
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
    let bodies = [&contact.ellipsoid.center, &second.center].map(|place| motion.body(place.on));
    let first = Body::of(
        graph,
        dimension,
        motion,
        &contact.ellipsoid.center,
        [&contact.ellipsoid.semi_axes, &contact.ellipsoid.axes],
    );
    let other = Body::of(
        graph,
        dimension,
        motion,
        &second.center,
        [&second.semi_axes, &second.axes],
    );
    let between = other.centre - first.centre;
    let meeting = match (first.radius, other.radius) {
        (Some(a), Some(b)) => Meeting::of_spheres(between, [a, b]),
        _ => Meeting::of(graph, dimension, [&first, &other], between),
    };
    let Meeting {
        direction,
        penetration,
        from_centre,
        overlap,
        search,
    } = meeting;
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
        overlap,
        normal: -direction,
        place: point,
        search: search.map(|search| (search, first.centre)),
        offset,
        offset_on_second,
        velocity,
        approach: direction.dot(velocity),
        between: Some(between),
        centre: first.offset,
        centre_on_second: first.centre - bodies[1].position,
        along: Vec::new(),
        moving: Vec::new(),
        flats: Vec::new(),
        tangents,
    }
}

/// The components of the normal; 0 where the centres coincide, as any direction, or its opposite, would do there.
pub fn direction<'g>(
    dimension: Dimension,
    normal: Vec3<'g>,
    between: Vec3<'g>,
) -> Vec<impl Fn() -> Expr<'g> + 'g> {
    let component = move |i: &usize| {
        let component = normal.0[*i];
        move || {
            let graph = component.graph();
            let smallest = graph.constant(SMALLEST_SQUARED_DISTANCE);
            choose(between.squared(), smallest, graph.constant(0.0), component)
        }
    };
    let used = used(dimension == Dimension::Plane).iter();
    used.map(component).collect()
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
        let zero = graph.constant(0.0);
        let round = used(dimension == Dimension::Plane)
            .iter()
            .all(|&i| a[i].id() == a[0].id());
        let quadric = if round {
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
        Body {
            centre: place.position,
            offset: place.offset,
            radius: round.then_some(a[0]),
            quadric,
        }
    }
}

/// The search for the direction in which two bodies overlap least.
pub(crate) struct Search<'g> {
    graph: &'g Graph,
    planar: bool,
    arguments: Vec<Expr<'g>>,
}

impl<'g> Search<'g> {
    /// A result. `early` if the search may end when it is clear that the bodies are apart.
    fn part(&self, early: bool, part: usize) -> Expr<'g> {
        let call = ApproachCall {
            planar: self.planar,
            early,
            part: part as u8,
        };
        self.graph.call(Function::Approach(call), &self.arguments)
    }

    fn vector(&self, early: bool, from: usize) -> Vec3<'g> {
        let mut vector = Vec3::zero(self.graph);
        for (k, &i) in used(self.planar).iter().enumerate() {
            vector.0[i] = self.part(early, from + k);
        }
        vector
    }

    /// n
    fn direction(&self, early: bool) -> Vec3<'g> {
        self.vector(early, 0)
    }

    /// δ
    fn overlap(&self, early: bool) -> Expr<'g> {
        self.part(early, used(self.planar).len())
    }

    /// Vector from the centre of the first body to the middle between the deepest points.
    fn to_middle(&self, early: bool) -> Vec3<'g> {
        self.vector(early, used(self.planar).len() + 1)
    }

    /// The normal, and the middle between the deepest points from the centre of the first body; also while the bodies
    /// are apart.
    pub(crate) fn nearest(&self) -> [Vec3<'g>; 2] {
        [-self.direction(false), self.to_middle(false)]
    }
}

/// The components of a vector that count.
fn used(planar: bool) -> &'static [usize] {
    if planar { &[0, 2] } else { &[0, 1, 2] }
}

/// The place where two bodies overlap most, or are nearest.
struct Meeting<'g> {
    /// n
    direction: Vec3<'g>,
    /// δ if the bodies touch, otherwise any negative number.
    penetration: Expr<'g>,
    /// δ
    overlap: Expr<'g>,
    /// Vector from the centre of the first body to the middle between the deepest points.
    from_centre: Vec3<'g>,
    /// None for two spheres.
    search: Option<Search<'g>>,
}

impl<'g> Meeting<'g> {
    fn of_spheres(between: Vec3<'g>, [a, b]: [Expr<'g>; 2]) -> Self {
        let smallest = a.graph().constant(SMALLEST_SQUARED_DISTANCE);
        let distance = between.squared().max(smallest).sqrt();
        let direction = distance.recip() * between;
        let penetration = a + b - distance;
        Meeting {
            direction,
            penetration,
            overlap: penetration,
            from_centre: a * direction - ((0.5 * penetration) * direction),
            search: None,
        }
    }

    fn of(
        graph: &'g Graph,
        dimension: Dimension,
        bodies: [&Body<'g>; 2],
        between: Vec3<'g>,
    ) -> Self {
        let planar = dimension == Dimension::Plane;
        let entries: &[usize] = if planar {
            &[0, 2, 4]
        } else {
            &[0, 1, 2, 3, 4, 5]
        };
        let quadrics = bodies.map(|body| entries.iter().map(|&k| body.quadric[k]));
        let search = Search {
            graph,
            planar,
            arguments: quadrics
                .into_iter()
                .flatten()
                .chain(used(planar).iter().map(|&i| between.0[i]))
                .collect(),
        };
        Meeting {
            direction: search.direction(true),
            penetration: search.overlap(true),
            overlap: search.overlap(false),
            from_centre: search.to_middle(true),
            search: Some(search),
        }
    }
}
