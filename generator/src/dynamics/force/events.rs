//! Where laws change their branch (event functions, which end steps), where they are not smooth (kinks), when they begin to act (onsets), and how
//! far the corners and ends of their curves are.

use super::{AppliedForces, choose, onset};
use crate::dynamics::numbers::{breakpoint_indicator, rate};
use crate::equations;
use crate::expression::passes::Recall;
use crate::expression::{ApproachCall, Expr, Function, Graph, Node};
use crate::model::{Contact, Curve, Extrapolate, Model, ScaledCurve};

/// The events of all laws.
pub struct Events<'g> {
    /// Functions whose change of sign is where a law changes its branch, by name.
    pub event_functions: Vec<(String, Expr<'g>)>,
    /// Functions whose change of sign is where a law is not smooth, by name. They are made when everything else is
    /// derived, so that they leave no trace in the equations.
    kinks: Vec<(String, Box<dyn Fn() -> Expr<'g> + 'g>)>,
    /// When laws begin to act, by name, made like kinks.
    pub(super) onsets: Vec<onset::Told<'g>>,
    /// How far the nearest corner of each curve is, by name, made like onsets.
    pub(super) corners: Vec<onset::Told<'g>>,
    /// Curves of the state, by name, made like kinks.
    curves: Vec<CurveOfState<'g>>,
    /// By curve of the model: whether it has kinks.
    pub(super) kinked: Vec<bool>,
    /// By curve of the model: where it is 0 on a whole interval.
    pub(super) idle: Vec<Vec<[f64; 2]>>,
    /// By curve of the model: its first abscissa, whether it is a line through 0 everywhere, and whether it ends.
    first_points: Vec<f64>,
    straight: Vec<bool>,
    ends: Vec<bool>,
}

impl Events<'_> {
    /// None, with what they need to know of the curves of a model.
    pub fn none(model: &Model) -> Self {
        let curves = &model.curves;
        let ends = |c: &Curve| c.extrapolate == Extrapolate::Error;
        Events {
            event_functions: Vec::new(),
            kinks: Vec::new(),
            onsets: Vec::new(),
            corners: Vec::new(),
            curves: Vec::new(),
            kinked: curves.iter().map(|c| !c.kinks().is_empty()).collect(),
            idle: curves.iter().map(Curve::idle).collect(),
            first_points: curves.iter().map(|c| c.points[0][0]).collect(),
            straight: curves.iter().map(Curve::is_proportional).collect(),
            ends: curves.iter().map(ends).collect(),
        }
    }
}

/// A curve at an argument that depends on the state, the bearing of a bent joint, or a component of the direction of a contact.
struct CurveOfState<'g> {
    /// Its name.
    name: String,
    /// What it is.
    what: equations::Watched,
    /// What stands for it where the force does not act: the first abscissa of a curve.
    idle: f64,
    /// Its argument in its own abscissa, the bearing, or the component.
    argument: Box<dyn Fn() -> Expr<'g> + 'g>,
    /// What is 0 while the force that it is part of does not act; else it is more.
    acts: Option<Expr<'g>>,
}

/// Where a curve acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// At all arguments.
    Everywhere,
    /// From its first point on: below, the law that it is part of makes 0 of it, as a slack belt and a contact apart do.
    AboveFirst,
}

impl<'g> AppliedForces<'g> {
    /// Ends steps where an expression changes its sign.
    pub fn event_function(&mut self, name: impl Into<String>, expression: Expr<'g>) {
        if expression.as_constant().is_none() {
            self.events.event_functions.push((name.into(), expression));
        }
    }

    /// Tells where a law is not smooth: where an expression changes its sign. `expression` is called when everything else
    /// is derived.
    pub fn kink(&mut self, name: impl Into<String>, expression: impl Fn() -> Expr<'g> + 'g) {
        self.events.kinks.push((name.into(), Box::new(expression)));
    }

    /// Tells of a curve of the state: what it is evaluated at, and where it is not smooth, if it is not. `which` it is of the
    /// `owner`; `argument` as in [`AppliedForces::kink`].
    pub fn curve_of_state(
        &mut self,
        owner: &str,
        which: &str,
        curve: &ScaledCurve,
        acts: Acts,
        argument: impl Fn() -> Expr<'g> + Copy + 'g,
    ) {
        let (scaled, first) = (curve.clone(), self.events.first_points[curve.curve]);
        let abscissa = move || {
            let argument = argument();
            let graph = argument.graph();
            let abscissa = argument * rate(graph, &scaled);
            match acts {
                Acts::Everywhere => abscissa,
                Acts::AboveFirst => abscissa.max(graph.constant(first)),
            }
        };
        // a line through 0 is as good a law beyond its points as between them
        if !self.events.straight[curve.curve] {
            self.events.curves.push(CurveOfState {
                name: format!("{owner}: {which}"),
                what: equations::Watched::Curve(curve.curve),
                idle: first,
                argument: Box::new(abscissa),
                acts: None,
            });
        }
        if self.events.kinked[curve.curve] {
            let curve = curve.clone();
            self.kink(format!("{owner}: kink of the {which}"), move || {
                let argument = argument();
                breakpoint_indicator(argument.graph(), &curve, argument)
            });
        }
    }

    /// Whether a curve of a contact must not be left, and has no value beyond its points.
    pub fn may_end(&self, contact: &Contact) -> bool {
        let unloading = contact.hysteresis.as_ref().map(|law| &law.unloading);
        let curves = [Some(&contact.elastic), unloading].into_iter().flatten();
        curves
            .flatten()
            .any(|scaled| self.events.ends[scaled.curve])
    }

    /// How many curves of the state are told of.
    pub fn curves_so_far(&self) -> usize {
        self.events.curves.len()
    }

    /// Of the curves of the state told of since there were so many: they count only while a force is not 0. It is never negative.
    pub fn curves_act(&mut self, since: usize, force: Expr<'g>) {
        for curve in &mut self.events.curves[since..] {
            curve.acts = Some(force);
        }
    }

    /// Tells of the bearing of a joint that bends, [`NO_BEARING`](equations::NO_BEARING) where it is bent by less than 90°, so that a run that goes through 180°
    /// says so.
    pub fn bearing(&mut self, owner: &str, bearing: impl Fn() -> Expr<'g> + 'g) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Bearing,
            idle: equations::NO_BEARING,
            argument: Box::new(bearing),
            acts: None,
        });
    }

    /// Tells how far an angle is from ±180°, to one side or the other, [`NO_BEARING`](equations::NO_BEARING) where it is nearer to 0, so that a run that goes
    /// through it says so.
    pub fn half_turn(&mut self, owner: &str, side: impl Fn() -> Expr<'g> + 'g) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::HalfTurn,
            idle: equations::NO_BEARING,
            argument: Box::new(side),
            acts: None,
        });
    }

    /// Tells of the share of the volume of an airbag that what it meets takes, while a force that is never negative is not 0.
    pub fn volume(&mut self, owner: &str, share: impl Fn() -> Expr<'g> + 'g, acts: Expr<'g>) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Volume,
            idle: 0.0,
            argument: Box::new(share),
            acts: Some(acts),
        });
    }

    /// Tells of the push of a fading edge over the elastic force of its plane, while that is not 0.
    pub fn edge(&mut self, owner: &str, ratio: impl Fn() -> Expr<'g> + 'g, force: Expr<'g>) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Edge,
            idle: 0.0,
            argument: Box::new(ratio),
            acts: Some(force),
        });
    }

    /// Tells of the direction in which two ellipsoids push each other, or a bushing turns, of length 1, or shorter where it is not determined, so
    /// that a run in which it leaps says so.
    pub fn direction(&mut self, owner: &str, components: Vec<impl Fn() -> Expr<'g> + 'g>) {
        for (i, component) in components.into_iter().enumerate() {
            self.events.curves.push(CurveOfState {
                name: owner.to_owned(),
                what: equations::Watched::Direction(i as u8),
                idle: equations::NO_BEARING,
                argument: Box::new(component),
                acts: None,
            });
        }
    }

    /// The curves of the state that all laws evaluate, with their abscissae, the bearings of joints that bend, and the directions of
    /// contacts of two ellipsoids. Made when everything else is derived.
    pub fn curves(&self, graph: &'g Graph) -> Vec<equations::CurveOfState> {
        graph.section("arguments of curves");
        let mut curves = Vec::new();
        for curve in &self.events.curves {
            // of a curve that must not be left the force is no number, and tells nothing
            let ends =
                matches!(curve.what, equations::Watched::Curve(index) if self.events.ends[index]);
            let argument = match curve.acts {
                Some(force) if !ends => {
                    let least = graph.constant(f64::MIN_POSITIVE);
                    let (idle, argument) = (graph.constant(curve.idle), (curve.argument)());
                    choose(force, least, idle, argument)
                }
                _ => (curve.argument)(),
            };
            if argument.as_constant().is_none() {
                curves.push(equations::CurveOfState {
                    name: curve.name.clone(),
                    what: curve.what,
                    argument: argument.id(),
                });
            }
        }
        curves
    }

    /// The kinks of all laws, each expression once.
    pub fn kinks(&self, graph: &'g Graph) -> Vec<(String, Expr<'g>)> {
        // the sign of a negative changes where that of the value does
        let unsigned = |value: Expr<'g>| match graph.node(value.id()) {
            Node::Neg(a) => a,
            _ => value.id(),
        };
        let mut kinks: Vec<(String, Expr<'g>)> = Vec::new();
        let mut exact = Recall::new(graph, exact);
        for (name, expression) in &self.events.kinks {
            graph.section(format!("kink {name}"));
            // whose sign is looked for must be continuous: no bound in the place of a distance
            let value = exact.expression(expression());
            let known = kinks
                .iter()
                .any(|(_, kink)| unsigned(*kink) == unsigned(value));
            if value.as_constant().is_none() && !known {
                kinks.push((name.clone(), value));
            }
        }
        kinks
    }
}

/// The same function, but with distances of bodies that do not touch in the place of what is at most these.
pub(super) fn exact(function: Function) -> Function {
    match function {
        Function::Approach(call) => Function::Approach(ApproachCall {
            early: false,
            ..call
        }),
        other => other,
    }
}
