//! A force of the user's own: one call with everything that the function wants to know, as scalars; the results applied.
//!
//! | | the function is given | and returns | which acts |
//! |---|---|---|---|
//! | point | position, velocity | force F | F on the body at the point |
//! | body | orientation, ω | moment M | M on the body |
//! | line | length L, L̇ | tension T | +T n on `from`, −T n on `to`, n from one to the other |
//! | joint | relative angles θ, θ̇ | torques Q | Σ Q_i n_i on the element, its opposite on the one that carries it |
//! | freedom of a joint | q, q̇ | torque or force Q | Q along the coordinate |
//! | state | z | ż | |
//!
//! Before the switch that the force waits for, and after the one that it ends with, nothing acts; states go on.
//!
//! Vectors are in absolute axes; n_i are the directions of [joints](crate::law::joint::force). Power: F·v, M·ω, −T L̇, Q·θ̇, Q q̇.

use super::outputs::{LineMeasures, UserMeasures};
use crate::dynamics::force::{Loads, Product};
use crate::dynamics::numbers::{curve, number};
use crate::dynamics::time;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph, UserCall};
use crate::law::belt::force as belt;
use crate::law::joint::JointMeasures;
use crate::law::joint::force as joint;
use crate::law::joint::force::Rotation;
use crate::law::{Equations, Measures, Setting};
use crate::model::{Body, Dimension, FieldComponent, User, UserFreedom};

impl Equations for User {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        loads: &mut Loads<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, loads))
    }
}

fn apply<'g>(user: &User, setting: Setting<'_, 'g>, loads: &mut Loads<'g>) -> UserMeasures<'g> {
    let Setting {
        graph,
        model,
        motion,
        index: force,
        name,
        gate,
        ..
    } = setting;
    if user.function.name.is_empty() {
        return nothing(graph, user);
    }
    // vectors have these components, rotations those
    let (axes, rotations): (&[usize], &[usize]) = match user.dimension {
        Dimension::Plane => (&[0, 2], &[1]),
        Dimension::Space => (&[0, 1, 2], &[0, 1, 2]),
    };

    let states: Vec<(usize, Expr<'g>)> = user
        .states
        .iter()
        .map(|state| {
            let initial = number(graph, &state.value.initial);
            let full = format!("user {name}: {}", state.name);
            loads.auxiliary(full, state.value.unit, initial)
        })
        .collect();

    let mut arguments = vec![time(graph)];
    arguments.extend(states.iter().map(|(_, value)| *value));
    let points: Vec<_> = user
        .points
        .iter()
        .map(|port| motion.attachment(graph, &port.value))
        .collect();
    for point in &points {
        for vector in [point.position, point.velocity] {
            arguments.extend(axes.iter().map(|&i| vector.0[i]));
        }
    }
    for port in &user.bodies {
        let body = motion.element(port.value);
        arguments.extend(match (user.dimension, model.dimension) {
            (Dimension::Plane, Dimension::Plane) => vec![body.angle],
            // of a planar motion in space: x of the element is (cos φ, 0, −sin φ)
            (Dimension::Plane, Dimension::Space) => {
                let forward = body.rotation.column(0);
                vec![(-forward.0[2]).atan2(forward.0[0])]
            }
            (Dimension::Space, _) => body.rotation.0.as_flattened().to_vec(),
        });
        arguments.extend(rotations.iter().map(|&i| body.omega.0[i]));
    }
    let mut lines = Vec::new();
    for port in &user.lines {
        let from = motion.attachment(graph, &port.value.from);
        let to = motion.attachment(graph, &port.value.to);
        let span = to.position - from.position;
        let length = belt::length(graph, span.squared());
        let direction = length.recip() * span;
        let rate = direction.dot(to.velocity - from.velocity);
        arguments.extend([length, rate]);
        lines.push((from, to, direction, length, rate));
    }
    let mut joints = Vec::new();
    for port in &user.joints {
        let parent = joint::parent(model, port.value);
        let about: Vec<Rotation<'g>> = rotations
            .iter()
            .map(|&i| match model.dimension {
                Dimension::Plane if i == 1 => joint::in_plane(graph, motion, port.value, parent),
                Dimension::Plane => Rotation {
                    angle: graph.constant(0.0),
                    rate: graph.constant(0.0),
                    direction: Vec3::zero(graph),
                    unit: "rad",
                },
                Dimension::Space => joint::in_space(graph, motion, port.value, parent, i),
            })
            .collect();
        arguments.extend(about.iter().map(|rotation| rotation.angle));
        arguments.extend(about.iter().map(|rotation| rotation.rate));
        joints.push((parent, about));
    }
    let freedoms: Vec<_> = (user.freedoms.iter())
        .map(|port| motion.element(port.value.element).freedoms[port.value.freedom])
        .collect();
    arguments.extend(freedoms.iter().flat_map(|(q, rate)| [*q, *rate]));
    for port in &user.function.parameters {
        arguments.push(match &port.value.value {
            FieldComponent::Constant(value) => number(graph, value),
            FieldComponent::Curve(scaled) => curve(graph, scaled, time(graph)),
        });
    }
    for port in &user.function.curves {
        arguments.extend(match &port.value {
            Some(scaled) => [number(graph, &scaled.times), number(graph, &scaled.stretch)],
            None => [graph.constant(0.0), graph.constant(1.0)],
        });
    }

    let names = user.results();
    let mut part = 0;
    let mut next = || {
        let call = UserCall {
            force: force as u16,
            arguments: arguments.len() as u16,
            part: part as u16,
            parts: names.len() as u16,
        };
        let value = graph.call(Function::User(call), &arguments);
        if let Some(result) = names.get(part) {
            graph.name(value, format!("{}_{result}", name.replace('-', "_")));
        }
        part += 1;
        value
    };
    let mut vector = |axes: &[usize]| {
        let mut vector = Vec3::zero(graph);
        for &axis in axes {
            vector.0[axis] = next();
        }
        vector
    };
    let forces: Vec<_> = points
        .iter()
        .map(|_| gate.of_vector(vector(axes)))
        .collect();
    let moments: Vec<_> = user
        .bodies
        .iter()
        .map(|_| gate.of_vector(vector(rotations)))
        .collect();
    let tensions: Vec<_> = lines.iter().map(|_| gate.of(next())).collect();
    let torques: Vec<Vec<_>> = joints
        .iter()
        .map(|(_, about)| about.iter().map(|_| gate.of(next())).collect())
        .collect();
    let efforts: Vec<_> = freedoms.iter().map(|_| gate.of(next())).collect();
    let rates: Vec<_> = states.iter().map(|_| next()).collect();

    let work = |port: &str| match user.ports() {
        1 => format!("user {name}"),
        _ => format!("user {name}: {port}"),
    };
    for ((port, point), &force) in user.points.iter().zip(&points).zip(&forces) {
        loads.apply(port.value.on, point.offset, force);
        if port.value.on != Body::Frame {
            loads.work(work(&port.name), Product::Vectors(force, point.velocity));
        }
    }
    for (port, &moment) in user.bodies.iter().zip(&moments) {
        loads.turn(Body::Element(port.value), moment);
        let omega = motion.element(port.value).omega;
        loads.work(work(&port.name), Product::Vectors(moment, omega));
    }
    let mut line_measures = Vec::new();
    for ((port, (from, to, direction, length, rate)), &tension) in
        user.lines.iter().zip(&lines).zip(&tensions)
    {
        let pull = tension * *direction;
        loads.apply(port.value.from.on, from.offset, pull);
        loads.apply(port.value.to.on, to.offset, -pull);
        loads.work(work(&port.name), Product::Scalars(-tension, *rate));
        line_measures.push(LineMeasures {
            tension,
            length: *length,
            rate: *rate,
        });
    }
    let mut joint_measures = Vec::new();
    for ((port, (parent, about)), torques) in user.joints.iter().zip(&joints).zip(&torques) {
        let mut measures = [None; 3];
        let mut moment = Vec3::zero(graph);
        for ((&i, rotation), &torque) in rotations.iter().zip(about).zip(torques) {
            moment = moment + torque * rotation.direction;
            loads.work(work(&port.name), Product::Scalars(torque, rotation.rate));
            measures[i] = Some(JointMeasures {
                torque,
                angle: rotation.angle,
                rate: rotation.rate,
                permanent_sets: [graph.constant(0.0); 2],
            });
        }
        loads.turn_joint(port.value, *parent, moment);
        joint_measures.push(measures);
    }
    for ((port, (_, rate)), &effort) in user.freedoms.iter().zip(&freedoms).zip(&efforts) {
        let UserFreedom {
            element, freedom, ..
        } = port.value;
        let on = &mut loads.wrenches.on_freedoms[element.system][element.element][freedom];
        *on = *on + effort;
        loads.work(work(&port.name), Product::Scalars(effort, *rate));
    }
    for ((index, _), &rate) in states.iter().zip(&rates) {
        loads.states.auxiliaries[*index].next = rate;
    }
    UserMeasures {
        forces,
        moments,
        lines: line_measures,
        joints: joint_measures,
        efforts,
        states: states
            .iter()
            .zip(rates)
            .map(|((_, value), rate)| (*value, rate))
            .collect(),
    }
}

/// Of a function that is left out: nothing acts, and its states stay.
fn nothing<'g>(graph: &'g Graph, user: &User) -> UserMeasures<'g> {
    let zero = graph.constant(0.0);
    let none = LineMeasures {
        tension: zero,
        length: zero,
        rate: zero,
    };
    UserMeasures {
        forces: vec![Vec3::zero(graph); user.points.len()],
        moments: vec![Vec3::zero(graph); user.bodies.len()],
        lines: vec![none; user.lines.len()],
        joints: vec![[None; 3]; user.joints.len()],
        efforts: vec![zero; user.freedoms.len()],
        states: vec![(zero, zero); user.states.len()],
    }
}
