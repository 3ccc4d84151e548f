//! Bushings: a spring and a damper in each of six directions, between a frame on one body and a frame on another.
//!
//! With the origins p₁, p₂ of the frames, their axes A₁, A₂ and velocities v, ω of the bodies, v₁ being that of the first body's material at p₂,
//!
//! d = A₁ᵀ (p₂ − p₁),   ḋ = A₁ᵀ (v₂ − v₁),   F = −A₁ (f_i(d_i) + c_i ḋ_i)
//!
//! acts on the second body at p₂, and −F on the first at the same place: so the power is −Σ (f_i + c_i ḋ_i) ḋ_i. The rotation is given by the Bryant
//! angles θ of A₁ᵀ A₂, and the moment on the second body, opposite to that on the first, is of the form that does the work Q·θ̇ (as in [joints](
//! crate::law::joint::force)):
//!
//! M = −Σ (g_i(θ_i) + e_i θ̇_i) n_i,   θ̇_i = n_i · (ω₂ − ω₁)
//!
//! For small angles n_i are the axes. At θ₂ = ±90° the first and the third angle are not defined: they leap by half a turn, and θ₂ turns back. A run that
//! goes through that says so by the [bearing](bryant_bearing). In the plane there are d₁, d₃ and θ₂, and nothing is singular.

use super::check::{Bushing, Direction, Mount};
use super::outputs::BushingMeasures;
use crate::dynamics::force::{Acts, AppliedForces, Product};
use crate::dynamics::kinematics::constant_rotation;
use crate::dynamics::numbers::{curve, number};
use crate::expression::Expr;
use crate::expression::vector::{Mat3, Vec3};
use crate::law::joint::force::{bryant, bryant_bearing};
use crate::law::{Equations, Measures, Setting};
use crate::model::Dimension;

const AXES: [&str; 3] = ["x", "y", "z"];

impl Equations for Bushing {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        let curves = applied.curves_so_far();
        let (displacement, force) = push(self, setting, applied);
        let (angles, moment) = turn(self, setting, applied);
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
        }
        if gate.waits() {
            applied.curves_act(curves, gate.of(graph.constant(1.0)));
        }
        Box::new(BushingMeasures {
            force,
            moment,
            displacement,
            angles,
        })
    }
}

/// d, and the force on the first body.
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
        resists.0[i] = resistance(law, way, setting, applied);
    }
    let force = axes.times(resists);
    applied.apply(first, offset, force);
    applied.apply(second, to.offset, -force);
    (displacement, force)
}

/// θ, and the moment on the first body.
fn turn<'g>(
    bushing: &Bushing,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> ([Expr<'g>; 3], Vec3<'g>) {
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
        moment = moment + resistance(law, way, setting, applied) * direction;
        angles[i] = angle;
    }
    applied.turn(first, moment);
    applied.turn(second, -moment);
    (angles, moment)
}

/// The axes of a frame in absolute axes.
fn axes<'g>(setting: Setting<'_, 'g>, mount: &Mount) -> Mat3<'g> {
    let own = constant_rotation(setting.graph, &mount.axes);
    setting.motion.body(mount.on.on).rotation.product(&own)
}

/// What a direction, with its coordinate and the rate of that, resists with.
fn resistance<'g>(
    law: &Direction,
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
        applied.curve_of_state(&owner, &which, elastic, Acts::Everywhere, argument);
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
