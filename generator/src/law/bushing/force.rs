//! Bushings: a spring and a damper in each of six directions, between a frame on one body and a frame on another.
//!
//! p₁, p₂ are the origins of the frames, A₁, A₂ their axes, v, ω the velocities of the bodies; v₁ is the velocity of
//! the first body's material at p₂. The force
//!
//! d = A₁ᵀ (p₂ − p₁),   ḋ = A₁ᵀ (v₂ − v₁),   F = −A₁ (f_i(d_i) + c_i ḋ_i)
//!
//! acts on the second body at p₂, and −F on the first body at the same point: so the power is −Σ (f_i + c_i ḋ_i) ḋ_i.
//! The rotation is given by the Bryant angles θ of A₁ᵀ A₂. The moment on the second body, which is opposite to that on
//! the first, does the work Q·θ̇ (as in [joints](crate::law::joint::force)):
//!
//! M = −Σ (g_i(θ_i) + e_i θ̇_i) n_i,   θ̇_i = n_i · (ω₂ − ω₁)
//!
//! A law of the whole rotation acts along the axis n of the rotation, as a function of its angle φ; its damping is the
//! same about all axes:
//!
//! M = −g(φ) n − e (ω₂ − ω₁),   2 sin φ n = Σ a_i × b_i,   2 cos φ + 1 = Σ a_i · b_i,   φ̇ = n · (ω₂ − ω₁)
//!
//! with the axes a_i of A₁ and b_i of A₂ (the antisymmetric part and the trace of A₁ᵀ A₂). So it stores ∫g dφ, and is
//! regular up to φ = 180°, where n reverses its direction.
//!
//! For small angles the n_i are the axes. At θ₂ = ±90° the first and the third angle are undefined: they jump by half a
//! turn, and θ₂ turns back. A run that passes through it reports so by means of the [bearing](bryant_bearing). A run in
//! which θ₁ or θ₃ of an elastic law, or φ, passes through 180°, where the torque jumps, reports that too. In the plane
//! there are d₁, d₃ and θ₂, and nothing is singular.

use super::keys::{Bushing, Direction, Mount};
use super::outputs::BushingMeasures;
use crate::equations::NO_BEARING;
use crate::expression::Expr;
use crate::expression::choose;
use crate::expression::vector::{Mat3, Vec3};
use crate::force::{Acts, AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::joint::force::{bryant, bryant_bearing, bryant_half_turn};
use crate::model::Dimension;
use crate::motion::kinematics::constant_rotation;
use crate::motion::numbers::{curve, number};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Lower bound of sin² φ: the square of the rounding error of a unit vector.
const SMALLEST_SINE_SQUARED: f64 = 1e-32;

impl Equations for Bushing {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        let curves = applied.curves_so_far();
        let (displacement, force) = push(self, setting, applied);
        let whole = self.turn != Direction::default();
        let Turned {
            angles,
            turn,
            moment,
        } = match whole {
            true => turn_as_a_whole(self, setting, applied),
            false => turn(self, setting, applied),
        };
        let Setting {
            graph, gate, name, ..
        } = setting;
        let turns = self.about.iter().any(|law| *law != Direction::default());
        if turns && setting.model.dimension == Dimension::Space {
            let frames = [&self.from, &self.to].map(|end| axes(setting, end));
            applied.bearing(&format!("bushing {name}"), move || {
                let [inboard, outboard] = &frames;
                bryant_bearing(graph, [inboard, outboard])
            });
            watch_half_turns(self, setting, applied);
        }
        if gate.waits() {
            applied.curves_act(curves, gate.of(graph.constant(1.0)));
        }
        Box::new(BushingMeasures {
            force,
            moment,
            displacement,
            angles,
            turn,
        })
    }
}

/// Watches the first and the third angle of an elastic law for passing through ±180°.
fn watch_half_turns<'g>(
    bushing: &Bushing,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) {
    let Setting { graph, name, .. } = setting;
    for i in [0, 2] {
        if bushing.about[i].elastic.is_some() {
            let frames = [&bushing.from, &bushing.to].map(|end| axes(setting, end));
            let owner = format!("bushing {name} about {}", AXES[i]);
            applied.half_turn(&owner, move || {
                let [inboard, outboard] = &frames;
                bryant_half_turn(graph, [inboard, outboard], i)
            });
        }
    }
}

/// The displacement d, and the force on the first body.
fn push<'g>(
    bushing: &Bushing,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> (Vec3<'g>, Vec3<'g>) {
    let Setting { graph, motion, .. } = setting;
    let (first, second) = (bushing.from.on.on, bushing.to.on.on);
    let [from, to] = [&bushing.from, &bushing.to].map(|end| motion.attachment(graph, &end.on));
    let axes = axes(setting, &bushing.from);
    let carried = motion.body(first);
    let offset = to.position - carried.position;
    let displacement = axes.transposed_times(to.position - from.position);
    let rates = axes.transposed_times(to.velocity - carried.velocity_at(offset));
    let mut resists = Vec3::zero(graph);
    for (i, law) in bushing.along.iter().enumerate() {
        let way = (format!("along {}", AXES[i]), displacement.0[i], rates.0[i]);
        resists.0[i] = resistance(law, "m", way, setting, applied);
    }
    let force = axes.times(resists);
    applied.apply(first, offset, force);
    applied.apply(second, to.offset, -force);
    (displacement, force)
}

/// The rotation of the second frame relative to the first, and the moment that resists it.
struct Turned<'g> {
    /// Bryant angles, or the components of the vector of the whole rotation \[rad\].
    angles: [Expr<'g>; 3],
    /// Angle of the whole rotation, if there is a law of it \[rad\].
    turn: Expr<'g>,
    /// The moment on the first body.
    moment: Vec3<'g>,
}

/// φ, the vector φ n in the axes of the first frame, and the moment on the first body.
fn turn_as_a_whole<'g>(
    bushing: &Bushing,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> Turned<'g> {
    let Setting {
        graph,
        motion,
        name,
        gate,
        ..
    } = setting;
    let (first, second) = (bushing.from.on.on, bushing.to.on.on);
    let [inboard, outboard] = [&bushing.from, &bushing.to].map(|end| axes(setting, end));
    let omega = motion.body(second).omega - motion.body(first).omega;
    let (half, one, zero) = (
        graph.constant(0.5),
        graph.constant(1.0),
        graph.constant(0.0),
    );
    let (mut across, mut trace) = (Vec3::zero(graph), zero);
    for i in 0..3 {
        let (a, b) = (inboard.column(i), outboard.column(i));
        across = across + a.cross(b);
        trace = trace + a.dot(b);
    }
    let (across, cosine) = (half * across, half * (trace - one));
    let sine = across
        .squared()
        .max(graph.constant(SMALLEST_SINE_SQUARED))
        .sqrt();
    let (angle, axis) = (sine.atan2(cosine), sine.recip() * across);
    let law = Direction {
        damping: None,
        ..bushing.turn.clone()
    };
    let way = ("about turn".to_owned(), angle, axis.dot(omega));
    let mut moment = resistance(&law, "rad", way, setting, applied) * axis;
    if let Some(damping) = &bushing.turn.damping {
        let resists = gate.of_vector(number(graph, damping) * omega);
        let work = format!("bushing {name}: damping about turn");
        applied.work(work, Product::Vectors(-resists, omega));
        moment = moment + resists;
    }
    if law.elastic.is_some() {
        let none = graph.constant(NO_BEARING);
        let component = |i: usize| move || choose(cosine, zero, axis.0[i], none);
        applied.direction(&format!("bushing {name}"), (0..3).map(component).collect());
    }
    applied.turn(first, moment);
    applied.turn(second, -moment);
    Turned {
        angles: inboard.transposed_times(angle * axis).0,
        turn: angle,
        moment,
    }
}

/// The Bryant angles θ, and the moment on the first body.
fn turn<'g>(
    bushing: &Bushing,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> Turned<'g> {
    let Setting { graph, motion, .. } = setting;
    let (first, second) = (bushing.from.on.on, bushing.to.on.on);
    let [inboard, outboard] = [&bushing.from, &bushing.to].map(|end| axes(setting, end));
    let omega = motion.body(second).omega - motion.body(first).omega;
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let mut moment = Vec3::zero(graph);
    let mut angles = [zero; 3];
    for (i, law) in bushing.about.iter().enumerate() {
        let (angle, direction) = match setting.model.dimension {
            Dimension::Space => bryant(graph, [&inboard, &outboard], i),
            Dimension::Plane if i == 1 => {
                let [from, to] = [&bushing.from, &bushing.to]
                    .map(|end| motion.body(end.on.on).angle + number(graph, &end.axes[1]));
                (to - from, Vec3([zero, one, zero]))
            }
            Dimension::Plane => continue,
        };
        let way = (format!("about {}", AXES[i]), angle, direction.dot(omega));
        moment = moment + resistance(law, "rad", way, setting, applied) * direction;
        angles[i] = angle;
    }
    applied.turn(first, moment);
    applied.turn(second, -moment);
    Turned {
        angles,
        turn: zero,
        moment,
    }
}

/// The axes of a frame in absolute axes.
fn axes<'g>(setting: Setting<'_, 'g>, mount: &Mount) -> Mat3<'g> {
    let own = constant_rotation(setting.graph, &mount.axes);
    setting.motion.body(mount.on.on).rotation.product(&own)
}

/// The force or moment f + c ẋ of one direction, from its coordinate, which has this unit, and its rate.
fn resistance<'g>(
    law: &Direction,
    unit: &'static str,
    (way, value, rate): (String, Expr<'g>, Expr<'g>),
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> Expr<'g> {
    let Setting {
        graph, name, gate, ..
    } = setting;
    let owner = format!("bushing {name}");
    let mut resists = graph.constant(0.0);
    if let Some(elastic) = &law.elastic {
        let (which, argument) = (format!("elastic curve {way}"), move || value);
        applied.curve_of_state(&owner, &which, unit, elastic, Acts::Everywhere, argument);
        applied.onset_of_curve(&format!("{owner} {way}"), gate, elastic, argument, rate);
        applied.corners(&owner, &which, gate, elastic, argument, move || rate);
        let force = gate.of(curve(graph, elastic, value));
        let work = format!("{owner}: elastic {way}");
        applied.work(work, Product::Scalars(-force, rate));
        resists = resists + force;
    }
    if let Some(damping) = &law.damping {
        let force = gate.of(number(graph, damping) * rate);
        let work = format!("{owner}: damping {way}");
        applied.work(work, Product::Scalars(-force, rate));
        resists = resists + force;
    }
    resists
}
