//! The problems that the [watch](super::watch) of a run can find, and their messages: since when, how much, what to do.

use crate::curve::Extrapolate;
use crate::model::{CurveInfo, CurveKind};
use crate::{Formula, Info};
use core::fmt;

/// A problem of a run that reached its end: the reason why its results cannot be trusted. Its names are those of the
/// model, which it borrows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnostic<'a> {
    /// The time when it began \[s\].
    pub t: f64,
    /// The problem.
    pub problem: Problem,
    /// The model, for its names.
    pub info: &'a Info<'a>,
}

/// What is wrong with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// Fixed steps are above the limit of stability.
    Step {
        /// The step \[s\].
        step: f64,
        /// The method.
        formula: Formula,
        /// Speed of the fastest motion, |λ| \[1/s\].
        rate: f64,
        /// The entry of the state that this motion moves most.
        index: usize,
    },
    /// The argument of a curve is so far outside of its points that the value of the curve is made up.
    Curve {
        /// The curve, an index in [`Info::curves`].
        curve: usize,
        /// The argument that was farthest outside.
        argument: f64,
    },
    /// A fixed step passed over an event that begins and ends within the step.
    Missed {
        /// The event, an index in [`Info::onsets`].
        onset: usize,
        /// The number of such steps.
        steps: u64,
    },
    /// A flexion went through 180°; or a bushing, or a joint with laws about x, y and z, through ±90° about y; or an
    /// angle through ±180°, where its torque jumps.
    Flexion {
        /// The direction of bending that jumped, an index in [`Info::curves`].
        bearing: usize,
    },
    /// Two ellipsoids sank into each other until the direction of their force jumped.
    Sunk {
        /// The direction that jumped, an index in [`Info::curves`].
        contact: usize,
    },
    /// The balance of energy has a gap.
    Energy {
        /// The largest gap, as a share of the largest energy.
        share: f64,
        /// The effect whose power was largest when the gap began, an index in [`Info::powers`].
        effect: Option<usize>,
        /// The entry of the state whose velocity was largest at that time.
        index: Option<usize>,
    },
    /// The balance of momentum of freely moving bodies has a gap.
    Momentum {
        /// The largest gap, as a share of the largest possible momentum.
        share: f64,
        /// The entry of the state whose velocity was largest when the gap began.
        index: Option<usize>,
    },
    /// The estimated error of fixed steps is too large.
    Error {
        /// The entry of the state whose error was largest when this began.
        index: usize,
    },
}

impl Problem {
    /// True if the motion goes to where a law says nothing or is singular: a more accurate run has the problem, too,
    /// unless only errors of this one lead there.
    pub fn lasts(&self) -> bool {
        match self {
            Problem::Curve { .. } | Problem::Flexion { .. } | Problem::Sunk { .. } => true,
            Problem::Step { .. }
            | Problem::Missed { .. }
            | Problem::Energy { .. }
            | Problem::Momentum { .. }
            | Problem::Error { .. } => false,
        }
    }

    /// The largest stable step \[s\], where the step is above it.
    pub fn largest_stable_step(&self) -> Option<f64> {
        match *self {
            Problem::Step { formula, rate, .. } => Some(formula.stability_limit()? / rate),
            _ => None,
        }
    }
}

impl<'a> Diagnostic<'a> {
    /// Name of the coordinate or velocity that is concerned, if there is one.
    pub fn coordinate(&self) -> Option<&'a str> {
        let index = match self.problem {
            Problem::Step { index, .. } | Problem::Error { index } => Some(index),
            Problem::Curve { .. }
            | Problem::Missed { .. }
            | Problem::Flexion { .. }
            | Problem::Sunk { .. } => None,
            Problem::Energy { index, .. } | Problem::Momentum { index, .. } => index,
        };
        self.info.state_name(index?)
    }

    /// The size of the problem: the step over the largest stable one, the argument of a curve, the number of steps, the
    /// angle of the jump \[rad\], or the share that is missing. 1 for the error of fixed steps.
    pub fn amount(&self) -> f64 {
        match self.problem {
            Problem::Step { step, .. } => step / self.problem.largest_stable_step().unwrap_or(step),
            Problem::Curve { argument, .. } => argument,
            Problem::Missed { steps, .. } => steps as f64,
            Problem::Flexion { .. } | Problem::Sunk { .. } => core::f64::consts::PI,
            Problem::Energy { share, .. } | Problem::Momentum { share, .. } => share,
            Problem::Error { .. } => 1.0,
        }
    }

    /// A word that names the kind of problem, for programs.
    pub fn kind(&self) -> &'static str {
        match self.problem {
            Problem::Step { .. } => "step",
            Problem::Curve { curve, .. } if self.is_volume(curve) => "volume",
            Problem::Curve { curve, .. } if self.is_edge(curve) => "edge",
            Problem::Curve { .. } => "curve",
            Problem::Missed { .. } => "missed",
            Problem::Flexion { bearing } if self.is_half_turn(bearing) => "turn",
            Problem::Flexion { bearing } if self.is_bushing(bearing) => "bushing",
            Problem::Flexion { bearing } if self.is_angles(bearing) => "angles",
            Problem::Flexion { .. } => "flexion",
            Problem::Sunk { .. } => "sunk",
            Problem::Energy { .. } => "energy",
            Problem::Momentum { .. } => "momentum",
            Problem::Error { .. } => "error",
        }
    }

    /// Whether an entry of [`Info::curves`] belongs to a bushing.
    fn is_bushing(&self, bearing: usize) -> bool {
        let curve = self.info.curves.get(bearing);
        curve.is_some_and(CurveInfo::is_of_bushing)
    }

    /// Whether an entry of [`Info::curves`] is an angle at ±180°, or the axis of a rotation of 180°.
    fn is_half_turn(&self, bearing: usize) -> bool {
        let kind = self.info.curves.get(bearing).map(|curve| curve.kind);
        matches!(kind, Some(CurveKind::HalfTurn | CurveKind::Direction(_)))
    }

    /// Whether an entry of [`Info::curves`] belongs to the laws about x, y and z of a joint.
    fn is_angles(&self, bearing: usize) -> bool {
        let curve = self.info.curves.get(bearing);
        curve.is_some_and(CurveInfo::is_of_angles)
    }

    /// Whether an entry of [`Info::curves`] is the volume of an airbag.
    fn is_volume(&self, curve: usize) -> bool {
        let curve = self.info.curves.get(curve);
        curve.is_some_and(|curve| curve.kind == CurveKind::Volume)
    }

    /// Whether an entry of [`Info::curves`] is the fading edge of a plane.
    fn is_edge(&self, curve: usize) -> bool {
        let curve = self.info.curves.get(curve);
        curve.is_some_and(|curve| curve.kind == CurveKind::Edge)
    }

    /// What the user can do about it.
    pub fn remedy(&self) -> &'static str {
        match self.problem {
            Problem::Step { .. } => {
                "give a smaller --step; or --tolerance instead, which finds the steps; or --method rodas5, which has no such limit"
            }
            Problem::Curve { curve, .. } if self.is_volume(curve) => {
                "give the bag more gas, a smaller vent or more volume, or let a contact stop the bodies before"
            }
            Problem::Curve { curve, .. } if self.is_edge(curve) => {
                "let the edge fade over the depth of the body, `edge: { rule: fade, width: … }`, or write `edge: { rule: cut }`; or give the plane more extent"
            }
            Problem::Curve { .. } => {
                "give the curve points as far as it is used; or write `extrapolate: hold` where its last value is meant to go on"
            }
            Problem::Missed { .. } | Problem::Error { .. } => {
                "give --tolerance instead of --step, which ends steps where something begins; or a smaller --step"
            }
            Problem::Flexion { bearing } if self.is_half_turn(bearing) => {
                "end the rotation before 180° by a stop or a larger stiffness; what turns farther needs a `hinge`, whose angle goes on beyond 180°, and the law on that"
            }
            Problem::Flexion { bearing } if self.is_bushing(bearing) => {
                "if the law is the same about all axes, write it as `about: { turn: … }`, which is regular up to 180°; else give it a stiffness about y that \
                 ends the rotation before 90°, or turn its frames so that the widest rotation is about x or z"
            }
            Problem::Flexion { bearing } if self.is_angles(bearing) => {
                "end this rotation by stops within ±80°, or let another rotation be the middle one of the three (`about: { order: yxz, … }`), or use `flexion` and `torsion`"
            }
            Problem::Flexion { .. } => {
                "let a stop or a stiffer curve end the bending before 180°, start the joint straighter, or give it laws `about` x, y, z"
            }
            Problem::Sunk { .. } => {
                "let the force, or something behind, stop the bodies before their middles meet; or give a smaller --step, or --tolerance instead"
            }
            Problem::Energy { .. } | Problem::Momentum { .. } => {
                "a smaller --tolerance or --step, or another --method, shows whether the gap goes down; if it does not, a \
                 force does not belong to its power; --energy-limit says how much may be missing"
            }
        }
    }
}

/// A number to three digits; with an exponent below 0.001 and from a million on.
struct Short(f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        match size {
            0.0 => f.write_str("0"),
            s if !(1e-3..1e6).contains(&s) => write!(f, "{:.2e}", self.0),
            s => {
                let decimals = [100.0, 10.0, 1.0, 0.1, 0.01].iter().take_while(|x| s < **x);
                write!(f, "{:.*}", decimals.count(), self.0)
            }
        }
    }
}

/// A time \[s\] in the largest of s, ms, µs and ns in which it is at least 1.
pub(crate) struct Time(pub f64);

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            s if s >= 1.0 || s == 0.0 => write!(f, "{} s", Short(s)),
            s if s >= 1e-3 => write!(f, "{} ms", Short(s * 1e3)),
            s if s >= 1e-6 => write!(f, "{} µs", Short(s * 1e6)),
            s => write!(f, "{} ns", Short(s * 1e9)),
        }
    }
}

impl fmt::Display for Diagnostic<'_> {
    // one `match` with a sentence for each problem
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.coordinate().unwrap_or("?");
        let name_of_curve = |index: usize| self.info.curves.get(index).map_or("?", |c| c.name);
        let since = match self.problem {
            Problem::Missed { .. } => "at",
            _ => "since",
        };
        write!(f, "{since} t = {} ", Time(self.t))?;
        match self.problem {
            Problem::Step {
                step,
                formula,
                rate,
                ..
            } => {
                let largest = self.problem.largest_stable_step().unwrap_or(step);
                let [step, largest] = [step, largest].map(Time);
                write!(
                    f,
                    "the step of {step} is above the stability limit of {formula} in this scene, about {largest} (a motion of {} 1/s, most \
                     in \"{name}\")",
                    Short(rate)
                )
            }
            Problem::Curve { curve, argument } => match self.info.curves.get(curve) {
                Some(curve) => OutOfRange { curve, argument }.fmt(f),
                None => f.write_str("the argument of a curve is outside of its points"),
            },
            Problem::Missed { onset, steps } => {
                let onset = self.info.onsets.get(onset).copied().unwrap_or("?");
                let which = match steps {
                    1 => "a step",
                    _ => "the first of several steps",
                };
                write!(
                    f,
                    "{which} passed over an event that begins and ends within the step: \"{onset}\""
                )
            }
            Problem::Flexion { bearing } => {
                let curve = self.info.curves.get(bearing);
                let singular = curve.map_or("?", CurveInfo::singular);
                write!(f, "\"{}\" {singular}", name_of_curve(bearing))
            }
            Problem::Sunk { contact } => write!(
                f,
                "the bodies of \"{}\" have sunk into each other so far that the direction of the force is not determined",
                name_of_curve(contact)
            ),
            Problem::Energy { share, effect, .. } => {
                write!(
                    f,
                    "the balance of energy has a gap of {} % of the largest energy in it; ",
                    Short(100.0 * share)
                )?;
                match effect.and_then(|effect| self.info.powers.get(effect)) {
                    Some(effect) => {
                        write!(f, "the largest power at that time is that of \"{effect}\"")
                    }
                    None => write!(f, "\"{name}\" moves fastest at that time"),
                }
            }
            Problem::Momentum { share, .. } => write!(
                f,
                "the balance of momentum of freely moving bodies has a gap of {} % of the largest possible momentum; \"{name}\" moves \
                 fastest at that time",
                Short(100.0 * share)
            ),
            Problem::Error { .. } => write!(
                f,
                "\"{name}\" errs by too much, as a comparison with steps half as long shows: the steps are too long for this motion"
            ),
        }
    }
}

/// A message: by how much the argument of a curve exceeds its points, and how the curve is extended.
pub(crate) struct OutOfRange<'a> {
    pub curve: &'a CurveInfo<'a>,
    pub argument: f64,
}

impl fmt::Display for OutOfRange<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let OutOfRange { curve, argument } = self;
        if curve.kind == CurveKind::Volume {
            let (name, left) = (curve.name, 100.0 * (1.0 - curve.last));
            return write!(
                f,
                "the {name} is compressed to less than {} % of its volume, where its law is no longer valid",
                Short(left)
            );
        }
        if curve.kind == CurveKind::Edge {
            return write!(
                f,
                "the edge of \"{}\" pushes harder than the surface, up to {} times as hard: it fades over less than the depth of the body",
                curve.name,
                Short(*argument)
            );
        }
        let how = match curve.extrapolate {
            Extrapolate::Linear => "the curve is extended as a straight line",
            Extrapolate::Hold => "the curve keeps its outermost value",
            Extrapolate::Error => "the curve may not be extended",
        };
        let (side, end) = match *argument < curve.first {
            true => ("is below the first point", curve.first),
            false => ("exceeds the last point", curve.last),
        };
        let (name, beyond) = (curve.name, (argument - end).abs());
        // a pure number has no unit
        let blank = if curve.unit.is_empty() { "" } else { " " };
        let unit = curve.unit;
        write!(
            f,
            "the argument of the curve \"{name}\" {side} ({}{blank}{unit}) by {}{blank}{unit}, and {how}",
            Short(end),
            Short(beyond)
        )
    }
}
