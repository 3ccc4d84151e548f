//! Joint torque: a separate law about each relative rotation θ_i.   \[MADYMO 1980, force model 1\]
//!
//! Q_i = −elastic(θ_i − neutral) − damping · θ̇_i + friction + stop(θ_i, θ̇_i) + lock(θ_i, θ̇_i) + motor(t) + drive(t,
//! θ_i, θ̇_i)
//!
//! In the plane θ = φ_child − φ_parent, and the moment is Q e_y. In space θ_i are the Bryant angles of A_parentᵀ
//! A_child, about the axes e₁ = x of the parent, e₃ = z of the child, and e₂ along e₃ × e₁. These axes are not
//! orthogonal. The moment that does the work Q·θ̇, and so stores the energy of the elastic curves, is
//!
//! M = Σ Q_i n_i,   n₂ = (e₃ × e₁)/c,   n₁ = (e₁ − s e₃)/c²,   n₃ = (e₃ − s e₁)/c²,   s = sin θ₂ = e₁·e₃,   c² = 1 − s²
//!
//! and by the same vectors θ̇_i = n_i · (ω_child − ω_parent). At θ₂ = ±90° the angles are undefined; c² is
//! kept ≥ 1e-12, so that forces stay finite there, and a run that passes through it reports so by means of the
//! [bearing](bryant_bearing). For another [Order] of the turns the same holds in right-handed axes (a, b, ±c): the
//! angle about −c is the angle about c with the opposite sign, and so is its n. [Flexion and torsion](bending) are two
//! more such coordinates, in space.
//!
//! At a depth δ > 0 behind a stop, N = max(0, k δ + d min(δ/fade, 1) δ̇) pushes back. A lock pulls with −k (θ − θ_l) −
//! d θ̇ to the angle θ_l, which is remembered from the moment when its switch began to act. [Friction](sticking),
//! [motors and drives](drive), and [the hysteresis](crate::force::hysteresis) of elastic curves have files of
//! their own.

mod bending;
mod drive;
mod sticking;

use super::check::{Freedom, Joint, Order};
use super::outputs::{AboutRotations, JointMeasures};
use crate::equations::NO_BEARING;
use crate::expression::choose;
use crate::expression::vector::{Mat3, Vec3};
use crate::expression::{Expr, Graph, sum};
use crate::force::fade::faded;
use crate::force::hysteresis;
use crate::force::onset::{Onset, absolute};
use crate::force::switch::Gate;
use crate::force::{Acts, AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::joint::check::{JointTorque, Lock, Stop};
use crate::law::joint::outputs::JointQuantity;
use crate::model::part::AXES;
use crate::model::{Body, Dimension, ElementId, Model, Quantity, Reference, ScaledCurve};
use crate::motion::Motion;
use crate::motion::numbers::{curve, number};

/// Lower bound of cos² θ₂.
const SMALLEST_COSINE_SQUARED: f64 = 1e-12;

/// cos² θ₂ below which the bearing of Bryant angles is watched: beyond 60°.
const NEAR: f64 = 0.25;

/// One relative rotation: its angle, its rate, and the direction of the moment that does work on it alone.
#[derive(Clone, Copy)]
pub struct Rotation<'g> {
    /// θ \[rad\].
    pub angle: Expr<'g>,
    /// θ̇ \[rad/s\].
    pub rate: Expr<'g>,
    /// n, by which θ̇ = n · (ω_child − ω_parent).
    pub direction: Vec3<'g>,
    /// Unit of the angle; "m" for a freedom that slides.
    pub unit: &'static str,
}

impl Equations for Joint {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, applied))
    }
}

impl Equations for Freedom {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        let measures = apply_to_freedom(self, setting, applied);
        Box::new([Some(measures), None, None, None, None])
    }
}

/// Applies the laws of a joint. Returns the measures of the three rotations, of flexion and of torsion, for each that
/// has a law or is observed.
fn apply<'g>(
    joint: &Joint,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> AboutRotations<'g> {
    let Setting {
        graph,
        model,
        motion,
        index,
        name,
        gate,
        ..
    } = setting;
    let (child, bending) = (joint.child, joint.bending.as_deref());
    let parent = parent(model, child);
    let curves = applied.curves_so_far();
    let owner = format!("joint {name}");
    let mut measures = [None; 5];
    let mut moment = Vec3::zero(graph);
    for (i, law) in joint.about.iter().enumerate() {
        let used = *law != JointTorque::default() || looked_at(model, index, i);
        if !used || (model.dimension == Dimension::Plane && i != 1) {
            continue;
        }
        let rotation = match model.dimension {
            Dimension::Plane => in_plane(graph, motion, child, parent),
            Dimension::Space => in_space(graph, motion, child, parent, (joint.order, i)),
        };
        let about = match model.dimension {
            Dimension::Plane => owner.clone(),
            Dimension::Space => format!("{owner} about {}", ["x", "y", "z"][i]),
        };
        let measured = apply_torques(graph, applied, (&owner, &about), gate, law, rotation);
        moment = moment + measured.torque * rotation.direction;
        measures[i] = Some(measured);
    }
    let looked = [3, 4].map(|i| looked_at(model, index, i));
    if bending.is_some() || looked.contains(&true) {
        let axis = bending.map_or(2, |b| b.axis);
        let bent = bending::Bent::of(graph, motion.body(parent), motion.element(child), axis);
        let none = JointTorque::default();
        let flexion = bending.map_or(&none, |b| &b.flexion);
        let torsion = bending.map_or(&none, |b| &b.torsion);
        if *flexion != none || looked[0] {
            let (resists, measured) = bent.flexion(graph, applied, &owner, gate, flexion);
            moment = moment + resists;
            measures[3] = Some(measured);
        }
        if *torsion != none || looked[1] {
            let about = format!("{owner} torsion");
            let names = (&*format!("{owner}: torsion"), &*about);
            let measured = apply_torques(graph, applied, names, gate, torsion, bent.twist);
            moment = moment + measured.torque * bent.twist.direction;
            measures[4] = Some(measured);
        }
    }
    if model.dimension == Dimension::Space && needs_angles(&joint.about, joint.order) {
        let axes = [motion.body(parent), motion.element(child)].map(|body| body.rotation);
        let (order, names) = (joint.order, joint.order.0.map(|axis| AXES[axis]));
        let [first, middle, last] = names;
        let name = format!("{owner} about {first}, {middle} and {last}");
        applied.bearing(&name, move || {
            let [inboard, outboard] = axes.map(|axes| ordered(axes, order));
            bryant_bearing(graph, [&inboard, &outboard])
        });
    }
    if model.dimension == Dimension::Space {
        watch_half_turns(joint, setting, applied);
    }
    if gate.waits() {
        applied.curves_act(curves, gate.of(graph.constant(1.0)));
    }
    if let Some(bending) = bending.filter(|b| b.directs()) {
        let [inboard, outboard] =
            [motion.body(parent), motion.element(child)].map(|body| body.rotation);
        let axis = bending.axis;
        applied.bearing(&owner, move || {
            bending::bearing(graph, inboard, outboard, axis)
        });
    }
    applied.turn_joint(child, parent, moment);
    measures
}

/// Watches the first and the last angle of the order, and the torsion, for passing through ±180°, if a torque depends
/// on the angle.
fn watch_half_turns<'g>(joint: &Joint, setting: Setting<'_, 'g>, applied: &mut AppliedForces<'g>) {
    let Setting {
        graph,
        model,
        motion,
        name,
        ..
    } = setting;
    let bodies = [
        motion.body(parent(model, joint.child)),
        motion.element(joint.child),
    ];
    let order = joint.order;
    for i in [0, 2] {
        let axis = order.0[i];
        if depends_on_angle(&joint.about[axis]) {
            let axes = bodies.map(|body| body.rotation);
            applied.half_turn(&format!("joint {name} about {}", AXES[axis]), move || {
                let [inboard, outboard] = axes.map(|axes| ordered(axes, order));
                bryant_half_turn(graph, [&inboard, &outboard], i)
            });
        }
    }
    if let Some(bending) = joint.bending.as_deref()
        && depends_on_angle(&bending.torsion)
    {
        let [inboard, outboard] = bodies;
        let [sine, cosine] = bending::Bent::of(graph, inboard, outboard, bending.axis).of_twist;
        applied.half_turn(&format!("joint {name} torsion"), move || {
            half_turn(graph, sine, cosine)
        });
    }
}

/// True if the laws about x, y and z have a different meaning beyond θ₂ = ±90°. There n₂ reverses its direction; but
/// the moment −d (n₂·ω) n₂ of damping about the middle axis, or of friction without a bristle, is the same for n₂ and
/// −n₂.
fn needs_angles(about: &[JointTorque; 3], order: Order) -> bool {
    let [x, y, z] = order.0.map(|axis| &about[axis]);
    let none = JointTorque::default();
    let (damping, friction) = (y.damping.clone(), y.friction.clone());
    let resists = JointTorque {
        damping,
        friction,
        ..JointTorque::default()
    };
    *x != none || *z != none || *y != resists
}

/// Applies the law of one freedom of a joint to its own coordinate: Q as for a relative rotation, in \[N\] if the
/// freedom slides.
fn apply_to_freedom<'g>(
    law: &Freedom,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> JointMeasures<'g> {
    let Setting {
        graph,
        model,
        motion,
        name,
        gate,
        ..
    } = setting;
    let Freedom {
        child,
        freedom,
        law,
    } = law;
    let (child, freedom) = (*child, *freedom);
    let joint = &model.systems[child.system].elements[child.element].joint;
    let [unit, _] = joint.freedoms()[freedom].kind.coordinate().units();
    let curves = applied.curves_so_far();
    let owner = format!("joint {name}");
    let (angle, rate) = motion.element(child).freedoms[freedom];
    let rotation = Rotation {
        angle,
        rate,
        direction: motion.element(child).axes[freedom],
        unit,
    };
    let measured = apply_torques(graph, applied, (&owner, &owner), gate, law, rotation);
    if gate.waits() {
        applied.curves_act(curves, gate.of(graph.constant(1.0)));
    }
    let on = &mut applied.wrenches.on_freedoms[child.system][child.element][freedom];
    *on = *on + measured.torque;
    measured
}

/// True if an output or a switch reads a rotation of a joint.
fn looked_at(model: &Model, force: usize, about: usize) -> bool {
    let outputs = model.outputs.iter();
    let outputs = outputs.flat_map(|output| output.quantity.leaves());
    let triggers = model.switches.iter().filter_map(|s| s.trigger.quantity());
    outputs.chain(triggers).any(|quantity| match quantity {
        Quantity::OfForce { force: f, what, .. } if *f == force => {
            what.get()
                .is_some_and(|asked: &crate::law::joint::outputs::JointOutput| {
                    asked.about == about && asked.what != JointQuantity::Torque
                })
        }
        _ => false,
    })
}

/// The measures of one relative rotation, with its torque Q; adds the power of each term. `owner` is the name for the
/// powers, `memory` that for memory and kinks.
fn apply_torques<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    (owner, memory): (&str, &str),
    gate: Gate<'g>,
    law: &JointTorque,
    rotation: Rotation<'g>,
) -> JointMeasures<'g> {
    let (terms, permanent_sets) = torques(graph, applied, memory, gate, law, rotation);
    let terms: Vec<_> = terms
        .into_iter()
        .map(|(term, torque)| (term, gate.of(torque)))
        .collect();
    for (term, torque) in &terms {
        let work = match owner.contains(": ") {
            true => format!("{owner}, {term}"),
            false => format!("{owner}: {term}"),
        };
        applied.work(work, Product::Scalars(*torque, rotation.rate));
    }
    JointMeasures {
        torque: sum(graph, terms.iter().map(|(_, torque)| *torque)),
        angle: rotation.angle,
        rate: rotation.rate,
        permanent_sets,
    }
}

/// The body that carries an element: its parent, a vehicle, or the absolute frame.
pub fn parent(model: &Model, child: ElementId) -> Body {
    let system = &model.systems[child.system];
    match (system.elements[child.element].parent, &system.reference) {
        (Some(element), _) => Body::Element(ElementId {
            system: child.system,
            element,
        }),
        (None, Reference::Riding { vehicle, .. }) => Body::Vehicle(*vehicle),
        (None, _) => Body::Frame,
    }
}

/// The terms of Q of one relative rotation, each with its name, and the permanent sets of its hysteresis.
fn torques<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    law: &JointTorque,
    rotation: Rotation<'g>,
) -> (Vec<(&'static str, Expr<'g>)>, [Expr<'g>; 2]) {
    let Rotation {
        angle, rate, unit, ..
    } = rotation;
    let (mut torques, mut sets) = (Vec::new(), [graph.constant(0.0); 2]);
    if let Some(elastic) = &law.elastic {
        let neutral = law
            .neutral
            .as_ref()
            .map_or(graph.constant(0.0), |n| number(graph, n));
        let argument = move || angle - neutral;
        let (resists, kept) =
            elastic_torque(applied, owner, gate, elastic, law, argument, rate, unit);
        sets = kept;
        torques.push(("elastic", -resists));
    }
    if let Some(damping) = &law.damping {
        torques.push(("damping", -(number(graph, damping) * rate)));
    }
    if let Some(friction) = &law.friction {
        let bristle = law.bristle.as_ref();
        let torque = sticking::friction(applied, owner, gate, friction, bristle, rotation);
        torques.push(("friction", torque));
    }
    if let Some(law) = &law.stop {
        stop_kinks(graph, applied, owner, gate, law, angle, rate);
        torques.push(("stop", stop(graph, law, angle, rate)));
    }
    if let Some(law) = &law.lock {
        torques.push(("lock", lock(graph, applied, owner, law, rotation)));
    }
    if let Some(motor) = &law.motor {
        torques.push(("motor", drive::motor(graph, motor)));
    }
    if let Some(law) = &law.drive {
        let torque = drive::drive(graph, applied, owner, law, rotation);
        torques.push(("drive", torque));
    }
    (torques, sets)
}

/// The torque of an elastic curve (with the sign of the curve), and the permanent sets of its hysteresis; adds its
/// events and kinks.
#[expect(
    clippy::too_many_arguments,
    reason = "whose, what law, and where on it"
)]
pub fn elastic_torque<'g>(
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    elastic: &ScaledCurve,
    law: &JointTorque,
    argument: impl Fn() -> Expr<'g> + Copy + 'g,
    rate: Expr<'g>,
    unit: &'static str,
) -> (Expr<'g>, [Expr<'g>; 2]) {
    applied.curve_of_state(
        owner,
        "elastic curve",
        unit,
        elastic,
        Acts::Everywhere,
        argument,
    );
    applied.onset_of_curve(owner, gate, elastic, argument, rate);
    applied.corners(owner, "elastic curve", gate, elastic, argument, move || {
        rate
    });
    let loading = curve(rate.graph(), elastic, argument());
    match &law.hysteresis {
        Some(law) => {
            hysteresis::apply_both_ways(applied, owner, unit, law, gate, argument, loading, rate)
        }
        None => (loading, [rate.graph().constant(0.0); 2]),
    }
}

/// The torque of the ends of a rotation.
pub fn stop<'g>(graph: &'g Graph, law: &Stop, angle: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
    let zero = graph.constant(0.0);
    let push = |beyond: Expr<'g>, rate: Expr<'g>| {
        let push = behind(graph, law, beyond, rate);
        match law.damping {
            Some(_) => push.max(zero),
            None => push,
        }
    };
    let above = law
        .to
        .as_ref()
        .map_or(zero, |to| push(angle - number(graph, to), rate));
    let below = law
        .from
        .as_ref()
        .map_or(zero, |from| push(number(graph, from) - angle, -rate));
    below - above
}

/// The push of a stop that has been passed by `beyond`; negative (a pull) where damping exceeds the elastic part.
fn behind<'g>(graph: &'g Graph, law: &Stop, beyond: Expr<'g>, rate: Expr<'g>) -> Expr<'g> {
    let zero = graph.constant(0.0);
    let depth = beyond.max(zero);
    let elastic = number(graph, &law.stiffness) * depth;
    let viscous = match (&law.damping, &law.damping_angle) {
        (None, _) => return elastic,
        (Some(damping), fade @ Some(_)) => {
            number(graph, damping) * faded(graph, depth, fade.as_ref()) * rate
        }
        // damping has its full size at once, but only behind the stop
        (Some(damping), None) => choose(zero, beyond, number(graph, damping) * rate, zero),
    };
    elastic + viscous
}

/// Adds the places where a stop begins and ends to push, and where its damping reaches its full size.
pub fn stop_kinks<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    gate: Gate<'g>,
    law: &Stop,
    angle: Expr<'g>,
    rate: Expr<'g>,
) {
    for (end, above) in [(&law.to, true), (&law.from, false)] {
        let Some(end) = end.clone() else { continue };
        let (law, which) = (law.clone(), if above { "upper" } else { "lower" });
        let beyond = move || match above {
            true => angle - number(graph, &end),
            false => number(graph, &end) - angle,
        };
        let name = format!("{owner}: {which} stop");
        let passed = beyond.clone();
        applied.onset(format!("{name} begins"), move || {
            gate.of_onset(Onset {
                gap: -passed(),
                speed: absolute(rate),
            })
        });
        if let (Some(_), Some(fade)) = (&law.damping, law.damping_angle.clone()) {
            let beyond = beyond.clone();
            applied.kink(format!("{name} damps in full"), move || {
                beyond() - number(graph, &fade)
            });
        }
        match law.damping {
            Some(_) => applied.kink(format!("{name} pushes"), move || {
                let (zero, beyond) = (graph.constant(0.0), beyond());
                let outwards = if above { rate } else { -rate };
                choose(zero, beyond, behind(graph, &law, beyond, outwards), beyond)
            }),
            None => applied.kink(format!("{name} begins"), beyond),
        }
    }
}

fn lock<'g>(
    graph: &'g Graph,
    applied: &mut AppliedForces<'g>,
    owner: &str,
    law: &Lock,
    Rotation {
        angle, rate, unit, ..
    }: Rotation<'g>,
) -> Expr<'g> {
    let zero = graph.constant(0.0);
    let switch = applied.states.switches[law.by];
    let (index, held) = applied.memory(format!("{owner}: locked angle"), unit, zero);
    applied.states.memory[index].next = switch.once(held, angle);
    let mut torque = number(graph, &law.stiffness) * (angle - held);
    if let Some(damping) = &law.damping {
        torque = torque + number(graph, damping) * rate;
    }
    switch.once(-torque, zero)
}

/// Angle θ and rate θ̇ of the rotation in the plane; its direction is e_y.
pub fn in_plane<'g>(
    graph: &'g Graph,
    motion: &Motion<'g>,
    child: ElementId,
    parent: Body,
) -> Rotation<'g> {
    let (inboard, outboard) = (motion.body(parent), motion.element(child));
    let (zero, one) = (graph.constant(0.0), graph.constant(1.0));
    let rate = outboard.omega - inboard.omega;
    Rotation {
        angle: outboard.angle - inboard.angle,
        rate: rate.0[1],
        direction: Vec3([zero, one, zero]),
        unit: "rad",
    }
}

/// θ_i, θ̇_i and n_i of the turn about the axis i, where the turns have the given order.
pub fn in_space<'g>(
    graph: &'g Graph,
    motion: &Motion<'g>,
    child: ElementId,
    parent: Body,
    (order, i): (Order, usize),
) -> Rotation<'g> {
    let (inboard, outboard) = (motion.body(parent), motion.element(child));
    let axes = [inboard.rotation, outboard.rotation].map(|axes| ordered(axes, order));
    let turn = order.0.iter().position(|axis| *axis == i).unwrap_or(i);
    let (mut angle, mut direction) = bryant(graph, [&axes[0], &axes[1]], turn);
    if turn == 2 && order.hand() < 0.0 {
        (angle, direction) = (-angle, -direction);
    }
    Rotation {
        angle,
        rate: direction.dot(outboard.omega - inboard.omega),
        direction,
        unit: "rad",
    }
}

/// The axes of a body in the order of the turns; the third is reversed if they would be left-handed.
fn ordered<'g>(axes: Mat3<'g>, order: Order) -> Mat3<'g> {
    let [first, middle, last] = order.0.map(|axis| axes.column(axis));
    let last = if order.hand() < 0.0 { -last } else { last };
    Mat3::from_columns([first, middle, last])
}

/// The first angle \[rad\] while the second is beyond ±60°, otherwise [`NO_BEARING`]. The first angle jumps by half a
/// turn when the second passes through ±90°.
pub fn bryant_bearing<'g>(graph: &'g Graph, axes: [&Mat3<'g>; 2]) -> Expr<'g> {
    let sine = axes[0].column(0).dot(axes[1].column(2));
    let cosine_squared = graph.constant(1.0) - sine.squared();
    let (angle, _) = bryant(graph, axes, 0);
    let none = graph.constant(NO_BEARING);
    choose(cosine_squared, graph.constant(NEAR), angle, none)
}

/// The sine of the first angle (i = 0) or of the third (i = 2) while it is nearer to ±180° than to 0, otherwise
/// [`NO_BEARING`]. The sine changes its sign at ±180°.
pub fn bryant_half_turn<'g>(graph: &'g Graph, axes: [&Mat3<'g>; 2], i: usize) -> Expr<'g> {
    let [inboard, outboard] = axes;
    let along = |row: usize, column: usize| inboard.column(row).dot(outboard.column(column));
    let (sine, cosine) = match i {
        0 => (along(1, 2), along(2, 2)),
        _ => (along(0, 1), along(0, 0)),
    };
    half_turn(graph, sine, cosine)
}

/// The sine of an angle while its cosine is negative, otherwise [`NO_BEARING`].
fn half_turn<'g>(graph: &'g Graph, sine: Expr<'g>, cosine: Expr<'g>) -> Expr<'g> {
    choose(
        cosine,
        graph.constant(0.0),
        sine,
        graph.constant(NO_BEARING),
    )
}

/// True if a torque depends on the angle, so that the torque jumps when the angle jumps from 180° to −180°.
fn depends_on_angle(law: &JointTorque) -> bool {
    law.elastic.is_some() || law.stop.is_some() || law.lock.is_some() || law.drive.is_some()
}

/// θ_i and n_i of the second axes relative to the first.
pub fn bryant<'g>(
    graph: &'g Graph,
    [inboard, outboard]: [&Mat3<'g>; 2],
    i: usize,
) -> (Expr<'g>, Vec3<'g>) {
    let (first, third) = (inboard.column(0), outboard.column(2));
    let sine = first.dot(third);
    let cosine_squared =
        (graph.constant(1.0) - sine.squared()).max(graph.constant(SMALLEST_COSINE_SQUARED));
    match i {
        0 => {
            let y = inboard.column(1).dot(third);
            let z = inboard.column(2).dot(third);
            (
                (-y).atan2(z),
                cosine_squared.recip() * (first - sine * third),
            )
        }
        1 => {
            let cosine = cosine_squared.sqrt();
            (sine.atan2(cosine), cosine.recip() * third.cross(first))
        }
        _ => {
            let x = first.dot(outboard.column(0));
            let y = first.dot(outboard.column(1));
            (
                (-y).atan2(x),
                cosine_squared.recip() * (third - sine * first),
            )
        }
    }
}
