//! A force of the user's own: one call of the function, with all its arguments as scalars; its results are applied.
//!
//! | | arguments of the function | result | action |
//! |---|---|---|---|
//! | point | position, velocity | force F | F on the body at the point |
//! | body | orientation, ω | moment M | M on the body |
//! | line | length L, L̇ | tension T | +T n on `from`, −T n on `to`, n from one to the other |
//! | joint | relative angles θ, θ̇ | torques Q | Σ Q_i n_i on the element, its opposite on the one that carries it |
//! | freedom of a joint | q, q̇ | torque or force Q | Q along the coordinate |
//! | state | z | ż | |
//!
//! Before the switch that the force waits for, and after the switch that ends it, nothing acts; but the states continue
//! to change.
//!
//! Vectors are in absolute axes; n_i are the directions of [joints](crate::law::joint::force). Power: F·v, M·ω, −T L̇,
//! Q·θ̇, Q q̇.

use super::outputs::{LineMeasures, UserMeasures};
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Function, Graph, UserCall};
use crate::force::{AppliedForces, Product};
use crate::force::{Equations, Measures, Setting};
use crate::law::belt::force as belt;
use crate::law::joint::force as joint;
use crate::law::joint::force::Rotation;
use crate::law::joint::{JointMeasures, Order};
use crate::law::user::check::{User, UserFreedom, UserLine};
use crate::model::{Body, Dimension, ElementId, FieldComponent};
use crate::motion::Point;
use crate::motion::numbers::time;
use crate::motion::numbers::{curve, number};

impl Equations for User {
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g> {
        Box::new(apply(self, setting, applied))
    }
}

fn apply<'g>(
    user: &User,
    setting: Setting<'_, 'g>,
    applied: &mut AppliedForces<'g>,
) -> UserMeasures<'g> {
    let Setting { graph, name, .. } = setting;
    if user.function.name.is_empty() {
        return nothing(graph, user);
    }
    let axes = Axes::of(user);
    let states: Vec<(usize, Expr<'g>)> = user
        .states
        .iter()
        .map(|state| {
            let initial = number(graph, &state.value.initial);
            let full = format!("user {name}: {}", state.name);
            applied.auxiliary(full, state.value.unit, initial)
        })
        .collect();

    let mut arguments = vec![time(graph)];
    arguments.extend(states.iter().map(|(_, value)| *value));
    let seen = Seen::of(user, setting, axes, &mut arguments);
    arguments.extend(function_arguments(user, graph));

    let results = Results::of(user, setting, axes, &seen, &arguments);
    results.act(user, setting, &seen, applied);
    for ((index, _), &rate) in states.iter().zip(&results.rates) {
        applied.states.auxiliaries[*index].next = rate;
    }
    UserMeasures {
        lines: seen.line_measures(&results.tensions),
        joints: seen.joint_measures(graph, axes, &results.torques),
        forces: results.forces,
        moments: results.moments,
        efforts: results.efforts,
        states: states
            .iter()
            .zip(results.rates)
            .map(|((_, value), rate)| (*value, rate))
            .collect(),
    }
}

/// Indices of the components that the vectors of a function have.
#[derive(Clone, Copy)]
struct Axes {
    /// Components of a position, a velocity, a force.
    vectors: &'static [usize],
    /// Components of an angular velocity, a moment.
    rotations: &'static [usize],
}

impl Axes {
    fn of(user: &User) -> Self {
        match user.dimension {
            Dimension::Plane => Axes {
                vectors: &[0, 2],
                rotations: &[1],
            },
            Dimension::Space => Axes {
                vectors: &[0, 1, 2],
                rotations: &[0, 1, 2],
            },
        }
    }
}

/// The quantities that the function reads, in the order of the ports. Bodies are not stored here; they are found by
/// their elements.
struct Seen<'g> {
    points: Vec<Point<'g>>,
    lines: Vec<Line<'g>>,
    joints: Vec<JointMotion<'g>>,
    /// Coordinate and rate of each freedom.
    freedoms: Vec<(Expr<'g>, Expr<'g>)>,
}

/// A straight line between two points.
struct Line<'g> {
    from: Point<'g>,
    to: Point<'g>,
    /// The unit vector from the first point to the second.
    direction: Vec3<'g>,
    length: Expr<'g>,
    rate: Expr<'g>,
}

/// The relative rotations of a joint.
struct JointMotion<'g> {
    /// The body that carries the joint.
    parent: Body,
    about: Vec<Rotation<'g>>,
}

impl<'g> Seen<'g> {
    /// The quantities that the function reads. Adds them to the arguments, one kind after the other.
    fn of(
        user: &User,
        setting: Setting<'_, 'g>,
        axes: Axes,
        arguments: &mut Vec<Expr<'g>>,
    ) -> Self {
        let Setting { graph, motion, .. } = setting;
        let points: Vec<_> = user
            .points
            .iter()
            .map(|port| motion.attachment(graph, &port.value))
            .collect();
        for point in &points {
            for vector in [point.position, point.velocity] {
                arguments.extend(axes.vectors.iter().map(|&i| vector.0[i]));
            }
        }
        for port in &user.bodies {
            arguments.extend(orientation(user, setting, port.value));
            let omega = motion.element(port.value).omega;
            arguments.extend(axes.rotations.iter().map(|&i| omega.0[i]));
        }
        let mut lines = Vec::new();
        for port in &user.lines {
            let line = Line::of(&port.value, setting);
            arguments.extend([line.length, line.rate]);
            lines.push(line);
        }
        let mut joints = Vec::new();
        for port in &user.joints {
            let joint = JointMotion::of(port.value, setting, axes);
            arguments.extend(joint.about.iter().map(|rotation| rotation.angle));
            arguments.extend(joint.about.iter().map(|rotation| rotation.rate));
            joints.push(joint);
        }
        let freedoms: Vec<_> = (user.freedoms.iter())
            .map(|port| motion.element(port.value.element).freedoms[port.value.freedom])
            .collect();
        arguments.extend(freedoms.iter().flat_map(|(q, rate)| [*q, *rate]));
        Seen {
            points,
            lines,
            joints,
            freedoms,
        }
    }

    fn line_measures(&self, tensions: &[Expr<'g>]) -> Vec<LineMeasures<'g>> {
        let measures = |(line, &tension): (&Line<'g>, &Expr<'g>)| LineMeasures {
            tension,
            length: line.length,
            rate: line.rate,
        };
        self.lines.iter().zip(tensions).map(measures).collect()
    }

    fn joint_measures(
        &self,
        graph: &'g Graph,
        axes: Axes,
        torques: &[Vec<Expr<'g>>],
    ) -> Vec<[Option<JointMeasures<'g>>; 3]> {
        let of_joint = |(joint, torques): (&JointMotion<'g>, &Vec<Expr<'g>>)| {
            let mut measures = [None; 3];
            for ((&i, rotation), &torque) in axes.rotations.iter().zip(&joint.about).zip(torques) {
                measures[i] = Some(JointMeasures {
                    torque,
                    angle: rotation.angle,
                    rate: rotation.rate,
                    permanent_sets: [graph.constant(0.0); 2],
                });
            }
            measures
        };
        self.joints.iter().zip(torques).map(of_joint).collect()
    }
}

/// The orientation of an element: in the plane an angle, in space the nine entries of its rotation matrix, row by row.
fn orientation<'g>(user: &User, setting: Setting<'_, 'g>, element: ElementId) -> Vec<Expr<'g>> {
    let body = setting.motion.element(element);
    match (user.dimension, setting.model.dimension) {
        (Dimension::Plane, Dimension::Plane) => vec![body.angle],
        // for a planar motion in space: the axis x of the element is (cos φ, 0, −sin φ)
        (Dimension::Plane, Dimension::Space) => {
            let forward = body.rotation.column(0);
            vec![(-forward.0[2]).atan2(forward.0[0])]
        }
        (Dimension::Space, _) => body.rotation.0.as_flattened().to_vec(),
    }
}

impl<'g> Line<'g> {
    fn of(line: &UserLine, setting: Setting<'_, 'g>) -> Self {
        let Setting { graph, motion, .. } = setting;
        let from = motion.attachment(graph, &line.from);
        let to = motion.attachment(graph, &line.to);
        let span = to.position - from.position;
        let length = belt::length(graph, span.squared());
        let direction = length.recip() * span;
        let rate = direction.dot(to.velocity - from.velocity);
        Line {
            from,
            to,
            direction,
            length,
            rate,
        }
    }
}

impl<'g> JointMotion<'g> {
    fn of(element: ElementId, setting: Setting<'_, 'g>, axes: Axes) -> Self {
        let Setting {
            graph,
            model,
            motion,
            ..
        } = setting;
        let parent = joint::parent(model, element);
        let rotation = |&i: &usize| match model.dimension {
            Dimension::Plane if i == 1 => joint::in_plane(graph, motion, element, parent),
            Dimension::Plane => Rotation {
                angle: graph.constant(0.0),
                rate: graph.constant(0.0),
                direction: Vec3::zero(graph),
                unit: "rad",
            },
            Dimension::Space => {
                joint::in_space(graph, motion, element, parent, (Order::default(), i))
            }
        };
        JointMotion {
            parent,
            about: axes.rotations.iter().map(rotation).collect(),
        }
    }
}

/// The arguments that do not depend on the motion: parameters, and the factors of the curves.
fn function_arguments<'g>(user: &User, graph: &'g Graph) -> Vec<Expr<'g>> {
    let mut arguments = Vec::new();
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
    arguments
}

/// The results of the function, in the order of the ports. While the force does not act, all but the rates of states
/// are 0.
struct Results<'g> {
    forces: Vec<Vec3<'g>>,
    moments: Vec<Vec3<'g>>,
    tensions: Vec<Expr<'g>>,
    /// For each joint, the torques about its relative rotations.
    torques: Vec<Vec<Expr<'g>>>,
    efforts: Vec<Expr<'g>>,
    /// Rates of the states.
    rates: Vec<Expr<'g>>,
}

impl<'g> Results<'g> {
    /// Calls the function, and groups its results by kind.
    fn of(
        user: &User,
        setting: Setting<'_, 'g>,
        axes: Axes,
        seen: &Seen<'g>,
        arguments: &[Expr<'g>],
    ) -> Self {
        let Setting {
            graph, name, gate, ..
        } = setting;
        let names = user.results();
        let mut part = 0;
        let mut next = || {
            let call = UserCall {
                force: setting.index as u16,
                arguments: arguments.len() as u16,
                part: part as u16,
                parts: names.len() as u16,
            };
            let value = graph.call(Function::User(call), arguments);
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
            gate.of_vector(vector)
        };
        let forces = user.points.iter().map(|_| vector(axes.vectors)).collect();
        let moments = user.bodies.iter().map(|_| vector(axes.rotations)).collect();
        let tensions = seen.lines.iter().map(|_| gate.of(next())).collect();
        let torques = seen
            .joints
            .iter()
            .map(|joint| joint.about.iter().map(|_| gate.of(next())).collect())
            .collect();
        Results {
            forces,
            moments,
            tensions,
            torques,
            efforts: seen.freedoms.iter().map(|_| gate.of(next())).collect(),
            rates: user.states.iter().map(|_| next()).collect(),
        }
    }

    /// Applies the results to the bodies and joints, and adds their powers.
    fn act(
        &self,
        user: &User,
        setting: Setting<'_, 'g>,
        seen: &Seen<'g>,
        applied: &mut AppliedForces<'g>,
    ) {
        let Setting {
            graph,
            motion,
            name,
            ..
        } = setting;
        let work = |port: &str| match user.ports() {
            1 => format!("user {name}"),
            _ => format!("user {name}: {port}"),
        };
        for ((port, point), &force) in user.points.iter().zip(&seen.points).zip(&self.forces) {
            applied.apply(port.value.on, point.offset, force);
            if port.value.on != Body::Frame {
                applied.work(work(&port.name), Product::Vectors(force, point.velocity));
            }
        }
        for (port, &moment) in user.bodies.iter().zip(&self.moments) {
            applied.turn(Body::Element(port.value), moment);
            let omega = motion.element(port.value).omega;
            applied.work(work(&port.name), Product::Vectors(moment, omega));
        }
        for ((port, line), &tension) in user.lines.iter().zip(&seen.lines).zip(&self.tensions) {
            let pull = tension * line.direction;
            applied.apply(port.value.from.on, line.from.offset, pull);
            applied.apply(port.value.to.on, line.to.offset, -pull);
            applied.work(work(&port.name), Product::Scalars(-tension, line.rate));
        }
        for ((port, joint), torques) in user.joints.iter().zip(&seen.joints).zip(&self.torques) {
            let mut moment = Vec3::zero(graph);
            for (rotation, &torque) in joint.about.iter().zip(torques) {
                moment = moment + torque * rotation.direction;
                applied.work(work(&port.name), Product::Scalars(torque, rotation.rate));
            }
            applied.turn_joint(port.value, joint.parent, moment);
        }
        for ((port, (_, rate)), &effort) in
            user.freedoms.iter().zip(&seen.freedoms).zip(&self.efforts)
        {
            let UserFreedom {
                element, freedom, ..
            } = port.value;
            let on = &mut applied.wrenches.on_freedoms[element.system][element.element][freedom];
            *on = *on + effort;
            applied.work(work(&port.name), Product::Scalars(effort, *rate));
        }
    }
}

/// The measures of a function that is left out: all forces are 0, and its states are constant.
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
