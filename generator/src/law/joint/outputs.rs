//! Outputs of a law in a joint.

use super::check::{Freedom, Joint};
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::force::{Measures, Value};
use crate::model::Quantity;
use crate::model::law::{Measured, OfLaw, Side, Visible};
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use serde::Serialize;

/// A quantity of a law in a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum JointQuantity {
    /// Generalised torque on the child about the relative rotation \[N m\].
    Torque,
    /// Relative angle \[rad\].
    Angle,
    /// Rate of the relative angle \[rad/s\].
    Rate,
    /// Permanent set of the hysteresis above the neutral angle, relative to it \[rad\]; \[m\] for a freedom that
    /// slides.
    SetAbove,
    /// Permanent set below the neutral angle, relative to it; negative.
    SetBelow,
}

/// A quantity of a joint force, and the rotation or freedom that it belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct JointOutput {
    /// Index of the relative rotation, 0 to 2 (1 in the plane); 3 is flexion, 4 torsion. 0 for a freedom.
    pub about: usize,
    /// The quantity.
    pub what: JointQuantity,
}

impl OfLaw for JointOutput {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }

    fn exists_in_plane(&self) -> bool {
        self.about == 1
    }
}

/// Names and units of the quantities of a relative rotation.
const OF_JOINT: [(&str, &str, JointQuantity); 5] = [
    ("torque", "N*m", JointQuantity::Torque),
    ("angle", "rad", JointQuantity::Angle),
    ("rate", "rad/s", JointQuantity::Rate),
    ("permanent_set_above", "rad", JointQuantity::SetAbove),
    ("permanent_set_below", "rad", JointQuantity::SetBelow),
];

/// Names and units of the quantities of the law of a freedom: one that turns, and one that slides.
const OF_LAW: [[(&str, &str, JointQuantity); 3]; 2] = [
    [
        ("torque", "N*m", JointQuantity::Torque),
        ("permanent_set_above", "rad", JointQuantity::SetAbove),
        ("permanent_set_below", "rad", JointQuantity::SetBelow),
    ],
    [
        ("effort", "N", JointQuantity::Torque),
        ("permanent_set_above", "m", JointQuantity::SetAbove),
        ("permanent_set_below", "m", JointQuantity::SetBelow),
    ],
];

impl Outputs for Joint {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        of_joint(resolver, at);
        resolver.without(at, &["freedom"], "a ball joint");
        let (what, unit) = resolver.look_up(written, &OF_JOINT, "a joint", at)?;
        let about = resolver.about(written, at)?;
        let what = JointOutput { about, what };
        Some((Quantity::of_force(force, what), unit))
    }
}

impl Visible for Joint {
    fn direction(&self, asked: &dyn OfLaw) -> Measured {
        asked
            .get()
            .map_or(Measured::Undirected, |asked: &JointOutput| {
                Measured::About(self.child, asked.about, asked.side())
            })
    }
}

impl JointOutput {
    /// The body whose load or motion the quantity is.
    fn side(self) -> Side {
        match self.what {
            JointQuantity::Torque => Side::Load,
            _ => Side::Motion,
        }
    }
}

impl Outputs for Freedom {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        of_joint(resolver, at);
        resolver.without(at, &["about", "freedom"], "the force of one freedom");
        let element = &resolver.systems[self.child.system].elements[self.child.element];
        let freedom = &element.joint.freedoms()[self.freedom];
        let table = &OF_LAW[usize::from(!freedom.kind.turns())];
        let (what, unit) = resolver.look_up(written, table, "the force of a freedom", at)?;
        let what = JointOutput { about: 0, what };
        Some((Quantity::of_force(force, what), unit))
    }
}

impl Visible for Freedom {
    fn direction(&self, asked: &dyn OfLaw) -> Measured {
        asked
            .get()
            .map_or(Measured::Undirected, |asked: &JointOutput| {
                Measured::Freedom(self.child, self.freedom, asked.side())
            })
    }
}

/// Reports keys that have no meaning for the scalars of a joint.
fn of_joint(resolver: &Resolver<'_>, at: At<'_>) {
    resolver.without(at, &["segment", "ring"], "anything but a belt");
    let keys = ["at", "component", "axes", "relative_to", "on"];
    resolver.without(at, &keys, "the scalars of a joint");
}

/// Expressions of the quantities of one relative rotation.
#[derive(Clone, Copy)]
pub struct JointMeasures<'g> {
    /// Generalised torque on the child \[N m\].
    pub torque: Expr<'g>,
    /// Relative angle \[rad\].
    pub angle: Expr<'g>,
    /// Rate of the relative angle \[rad/s\].
    pub rate: Expr<'g>,
    /// Permanent sets above and below the neutral angle, relative to it: where the elastic torque would vanish if it
    /// fell from here \[rad\]; 0 without hysteresis.
    pub permanent_sets: [Expr<'g>; 2],
}

/// Measures of a joint: of the three relative rotations, of flexion and of torsion, for each that has a law or is
/// observed.
pub type AboutRotations<'g> = [Option<JointMeasures<'g>>; 5];

impl<'g> Measures<'g> for AboutRotations<'g> {
    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let JointOutput { about, what } = asked.get()?;
        let measures = self[*about]?;
        Some(Value::Scalar(match what {
            JointQuantity::Torque => measures.torque,
            JointQuantity::Angle => measures.angle,
            JointQuantity::Rate => measures.rate,
            JointQuantity::SetAbove => measures.permanent_sets[0],
            JointQuantity::SetBelow => measures.permanent_sets[1],
        }))
    }
}
