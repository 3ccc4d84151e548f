//! Records where laws change their branch (event functions, whose roots end steps), where laws are not smooth (kinks),
//! when laws begin to act (onsets), and the distances to the corners of their curves.

use super::{AppliedForces, onset};
use crate::equations;
use crate::expression::choose;
use crate::expression::passes::Recall;
use crate::expression::{ApproachCall, Expr, Function, Graph, Node};
use crate::model::{Curve, Extrapolate, Model, ScaledCurve};
use crate::motion::numbers::{breakpoint_indicator, rate};

/// The events of all laws.
pub struct Events<'g> {
    /// Functions that change sign where a law changes its branch, by name.
    pub event_functions: Vec<(String, Expr<'g>)>,
    /// Functions that change sign where a law is not smooth, by name. Their expressions are made after all others, so
    /// that they do not change the equations.
    kinks: Vec<(String, Box<dyn Fn() -> Expr<'g> + 'g>)>,
    /// The onsets of laws, by name, made like the kinks.
    pub(super) onsets: Vec<onset::DeferredOnset<'g>>,
    /// The distance to the nearest corner of each curve of the state, by name, made like the onsets.
    pub(super) corners: Vec<onset::DeferredOnset<'g>>,
    /// Curves whose argument depends on the state, and quantities watched like one, made like the kinks.
    curves: Vec<CurveOfState<'g>>,
    /// By curve of the model: true if the curve has kinks.
    pub(super) kinked: Vec<bool>,
    /// By curve of the model: the intervals on which the curve is 0.
    pub(super) idle: Vec<Vec<[f64; 2]>>,
    /// By curve of the model: its first abscissa; true if it is a straight line through 0; true if it has no value
    /// beyond its end points.
    first_points: Vec<f64>,
    straight: Vec<bool>,
    ends: Vec<bool>,
}

impl Events<'_> {
    /// No events, with the properties of the model's curves.
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

/// A curve whose argument depends on the state, or another quantity that is watched like such an argument
/// ([`Watched`](equations::Watched)).
struct CurveOfState<'g> {
    /// Its name.
    name: String,
    /// The kind of watched quantity.
    what: equations::Watched,
    /// The value of `argument` while the force does not act: for a curve its first abscissa.
    idle: f64,
    /// The argument, as an abscissa of the curve's points; or the bearing, the component of a direction, the ratio.
    argument: Box<dyn Fn() -> Expr<'g> + 'g>,
    /// An expression that is 0 while the force does not act, and positive otherwise; `None` if the argument always
    /// counts.
    acts: Option<Expr<'g>>,
}

/// The arguments at which a curve acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Acts {
    /// At all arguments.
    Everywhere,
    /// From its first point on. Below it, the law makes its force 0, as a slack belt or an open contact does.
    AboveFirst,
}

impl<'g> AppliedForces<'g> {
    /// Adds a function whose change of sign ends steps; constants are left out.
    pub fn event_function(&mut self, name: impl Into<String>, expression: Expr<'g>) {
        if expression.as_constant().is_none() {
            self.events.event_functions.push((name.into(), expression));
        }
    }

    /// Adds a function that changes its sign where a law is not smooth. `expression` is called after all other
    /// expressions are made.
    pub fn kink(&mut self, name: impl Into<String>, expression: impl Fn() -> Expr<'g> + 'g) {
        self.events.kinks.push((name.into(), Box::new(expression)));
    }

    /// Adds a curve of the state, and its kinks if it has any. `which` names the curve of the `owner` for people, and
    /// `unit` is the SI unit of its abscissa, "" for a pure number. `argument` is called as in [`AppliedForces::kink`].
    pub fn curve_of_state(
        &mut self,
        owner: &str,
        which: &str,
        unit: &'static str,
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
        // a line through 0 continues unchanged beyond its points, so its argument need not be watched
        if !self.events.straight[curve.curve] {
            self.events.curves.push(CurveOfState {
                name: format!("{owner}: {which}"),
                what: equations::Watched::Curve(curve.curve, unit),
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

    /// True if the curve has no value beyond its end points.
    pub fn ends(&self, curve: &ScaledCurve) -> bool {
        self.events.ends[curve.curve]
    }

    /// The number of curves of the state added so far.
    pub fn curves_so_far(&self) -> usize {
        self.events.curves.len()
    }

    /// Makes the curves of the state with index `since` and above count only while `force`, which is never negative, is
    /// not 0.
    pub fn curves_act(&mut self, since: usize, force: Expr<'g>) {
        for curve in &mut self.events.curves[since..] {
            curve.acts = Some(force);
        }
    }

    /// Adds the bearing of a joint that bends, so that a run can report a bend through 180°. The bearing is
    /// [`NO_BEARING`](equations::NO_BEARING) while the joint is bent by less than 90°.
    pub fn bearing(&mut self, owner: &str, bearing: impl Fn() -> Expr<'g> + 'g) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Bearing,
            idle: equations::NO_BEARING,
            argument: Box::new(bearing),
            acts: None,
        });
    }

    /// Adds the signed distance of an angle from ±180°, so that a run can report that the angle passes through ±180°.
    /// It is [`NO_BEARING`](equations::NO_BEARING) while the angle is nearer to 0.
    pub fn half_turn(&mut self, owner: &str, side: impl Fn() -> Expr<'g> + 'g) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::HalfTurn,
            idle: equations::NO_BEARING,
            argument: Box::new(side),
            acts: None,
        });
    }

    /// Adds the share of an airbag's volume that penetrating bodies take up. It counts only while `acts`, which is
    /// never negative, is not 0.
    pub fn volume(&mut self, owner: &str, share: impl Fn() -> Expr<'g> + 'g, acts: Expr<'g>) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Volume,
            idle: 0.0,
            argument: Box::new(share),
            acts: Some(acts),
        });
    }

    /// Adds the ratio of the push of a fading edge to the elastic force of its plane. It counts only while that force
    /// is not 0.
    pub fn edge(&mut self, owner: &str, ratio: impl Fn() -> Expr<'g> + 'g, force: Expr<'g>) {
        self.events.curves.push(CurveOfState {
            name: owner.to_owned(),
            what: equations::Watched::Edge,
            idle: 0.0,
            argument: Box::new(ratio),
            acts: Some(force),
        });
    }

    /// Adds the direction in which two ellipsoids push each other, or about which a bushing turns, so that a run can
    /// report a leap of the direction. The vector has length 1, or is shorter where the direction is not determined.
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

    /// The curves of the state of all laws with their abscissae, and all quantities that are watched like them. Must be
    /// called after all other expressions are made.
    pub fn curves(&self, graph: &'g Graph) -> Vec<equations::CurveOfState> {
        graph.section("arguments of curves");
        let mut curves = Vec::new();
        for curve in &self.events.curves {
            // beyond the points of a curve that ends, the force is NaN, so it cannot tell whether the curve acts
            let ends = matches!(curve.what, equations::Watched::Curve(index, _) if self.events.ends[index]);
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

    /// The kinks of all laws; equal expressions are listed once.
    pub fn kinks(&self, graph: &'g Graph) -> Vec<(String, Expr<'g>)> {
        // −x changes its sign where x does, so both count as the same kink
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
