//! Finds when a law begins to act, so that a run can tell that no step has skipped a short action.
//!
//! The *gap* of a law is positive while the law certainly does not act; its *speed* is an upper bound of the rate of
//! change of the gap. If the gaps at the ends of a time h are g₀ and g₁ and the speed in between is at most c, no gap
//! in between is below (g₀ + g₁ − c h)/2.
//!
//! | law | gap | speed |
//! |---|---|---|
//! | ellipsoid and plane | −δ | \|n·v\| + \|ω\| r |
//! | plane with edges | the largest of −δ and \|ξ_i\| − e_i | the largest of the speeds of these, \|t_i·v\| + \|ω\| (a + a²/b) for ξ_i |
//! | two ellipsoids | a lower bound of their distance | the smaller of \|v\| + \|ω\| r₁, and \|ċ₂ − ċ₁\| + \|ω₁\| r₁ + \|ω₂\| r₂ |
//! | belt | ℓ − L | \|ḋ\| + \|ṙ\| |
//! | stop | angle left to the stop | \|θ̇\| |
//! | corner of a curve | distance of the abscissa from the corner, with a sign that changes at each corner | speed of the abscissa |
//!
//! δ is the penetration of a plane with the normal n; ξ_i is the coordinate of the deepest point along the edge
//! direction t_i, and e_i the half length. A belt has the length ℓ, and the path between its points has the length L. ḋ
//! is the relative velocity of its points, ṙ the rate at which it is taken in; webbing that leaves through rings or off
//! a film spool adds its rate. v is the velocity of the (first) ellipsoid's centre relative to the other body's
//! material there, ω the relative angular velocity, ċ the velocity of a centre; a and b are the largest and the
//! smallest semi-axis. r is the largest change of an ellipsoid's reach per angle: a − b. If the degree of the ellipsoid
//! is not 2, r is the distance R of its farthest point; its deepest point may then jump, and 2R replaces a + a²/b. For
//! a sphere both are 0. Speeds are relative between the two bodies, so bodies that move together have no speed.

use super::events::exact;
use super::switch::Gate;
use super::{AppliedForces, ElementMotion, Motion};
use crate::dynamics::kinematics::Point;
use crate::dynamics::numbers::{breakpoint_indicator, number, rate, vector};
use crate::expression::passes::Recall;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::law::types::{Against, Contact};
use crate::model::{Dimension, Ellipsoid, Number, ScaledCurve};

/// The gap of a law that cannot begin before another event, such as a switch.
pub const FAR: f64 = 1e30;

/// The name of an onset, and the function that makes it after all other expressions are made.
pub type Told<'g> = (String, Box<dyn Fn() -> Onset<'g> + 'g>);

/// The gap and the speed of a law.
#[derive(Clone, Copy)]
pub struct Onset<'g> {
    /// Positive while the law certainly does not act.
    pub gap: Expr<'g>,
    /// Upper bound of the rate of change of the gap, in the gap's unit per second.
    pub speed: Expr<'g>,
}

impl<'g> AppliedForces<'g> {
    /// Adds the onset of a law. `onset` is called after all other expressions are made.
    pub(crate) fn onset(&mut self, name: impl Into<String>, onset: impl Fn() -> Onset<'g> + 'g) {
        self.events.onsets.push((name.into(), Box::new(onset)));
    }

    /// Adds the onset of a curve of the state that is 0 on an interval: the gap is the distance of the argument from
    /// the end of the interval. `speed` is the rate of the argument, of any sign.
    pub(crate) fn onset_of_curve(
        &mut self,
        owner: &str,
        gate: Gate<'g>,
        curve: &ScaledCurve,
        argument: impl Fn() -> Expr<'g> + 'g,
        speed: Expr<'g>,
    ) {
        let idle = self.events.idle[curve.curve].clone();
        if idle.is_empty() {
            return;
        }
        let curve = curve.clone();
        self.onset(format!("{owner}: leaves where its curve is 0"), move || {
            let scale = rate(speed.graph(), &curve);
            let (x, graph) = (argument() * scale, speed.graph());
            let inside = |[from, to]: &[f64; 2]| {
                let above = from.is_finite().then(|| x - graph.constant(*from));
                let below = to.is_finite().then(|| graph.constant(*to) - x);
                match (above, below) {
                    (Some(above), Some(below)) => above.min(below),
                    (one, other) => one.or(other).unwrap_or(graph.constant(FAR)),
                }
            };
            let all = idle.iter().map(inside);
            gate.of_onset(Onset {
                gap: all.reduce(Expr::max).unwrap_or(graph.constant(FAR)),
                speed: absolute(speed * scale),
            })
        });
    }

    /// Adds the corners of a curve of the state as onsets, so that a step that passes a corner and returns is noticed.
    /// `which` names the curve of the `owner` for people; `speed` is the rate of the argument, of any sign.
    pub(crate) fn corners(
        &mut self,
        owner: &str,
        which: &str,
        gate: Gate<'g>,
        curve: &ScaledCurve,
        argument: impl Fn() -> Expr<'g> + 'g,
        speed: impl Fn() -> Expr<'g> + 'g,
    ) {
        if !self.events.kinked[curve.curve] {
            return;
        }
        let (name, curve) = (format!("{owner}: corner of the {which}"), curve.clone());
        let corner = move || {
            let (argument, speed) = (argument(), speed());
            let graph = argument.graph();
            gate.of_onset(Onset {
                gap: breakpoint_indicator(graph, &curve, argument),
                speed: absolute(speed * rate(graph, &curve)),
            })
        };
        self.events.corners.push((name, Box::new(corner)));
    }

    /// The depth of a contact up to which its curve is 0, in the unit of the curve's argument.
    pub(crate) fn lead(&self, graph: &'g Graph, curve: &ScaledCurve) -> Expr<'g> {
        let from_zero = |interval: &&[f64; 2]| interval[0] <= 0.0 && 0.0 < interval[1];
        let idle = self.events.idle[curve.curve].iter().find(from_zero);
        match idle {
            Some([_, to]) if to.is_finite() => graph.constant(*to) / rate(graph, curve),
            Some(_) => graph.constant(FAR),
            None => graph.constant(0.0),
        }
    }

    /// The onsets of all laws, and the corners of their curves.
    pub fn onsets(&self, graph: &'g Graph) -> [Vec<(String, Onset<'g>)>; 2] {
        [&self.events.onsets, &self.events.corners].map(|onsets| Self::made(graph, onsets))
    }

    fn made(graph: &'g Graph, onsets: &[Told<'g>]) -> Vec<(String, Onset<'g>)> {
        let mut exact = Recall::new(graph, exact);
        let made = onsets.iter().map(|(name, onset)| {
            graph.section(format!("onset {name}"));
            let Onset { gap, speed } = onset();
            // a second derivative says something of a distance alone, not of a bound of it
            let gap = exact.expression(gap);
            (name.clone(), Onset { gap, speed })
        });
        // an onset that depends on parameters alone cannot begin during a run
        let changes =
            |onset: &Onset<'g>| onset.gap.as_constant().is_none() && !onset.speed.is_zero();
        made.filter(|(_, onset)| changes(onset)).collect()
    }
}

/// The length of a vector.
pub fn size<'g>(vector: Vec3<'g>) -> Expr<'g> {
    let parts: Vec<Expr<'g>> = vector
        .0
        .into_iter()
        .filter(|part| !part.is_zero())
        .collect();
    match parts[..] {
        [] => vector.0[0].graph().constant(0.0),
        [one] => one.max(-one),
        _ => vector.squared().sqrt(),
    }
}

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
        let places = [&contact.ellipsoid, contact.against.place()];
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
        let Contact {
            semi_axes, degree, ..
        } = &self.contact;
        Sizes::of(self.graph, self.dimension, semi_axes, *degree)
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

/// |x|
pub fn absolute<'g>(x: Expr<'g>) -> Expr<'g> {
    x.max(-x)
}
