//! What can be asked of a law in a joint.

use super::check::{Freedom, Joint};
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::law::{Asked, Measures, OfLaw, Outputs, Value};
use crate::model::Quantity;
use crate::model::resolve::Resolver;
use serde::Serialize;

/// Of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum JointQuantity {
    /// Generalised torque on the child about the relative rotation \[N m\].
    Torque,
    /// Relative angle \[rad\].
    Angle,
    /// Its rate \[rad/s\].
    Rate,
    /// The angle beyond the neutral one that its hysteresis keeps \[rad\]; m where it slides.
    SetAbove,
    /// The same before the neutral angle, where it is negative.
    SetBelow,
}

/// Which quantity of a joint force, and about what.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct JointOutput {
    /// Which of the three relative rotations (1 in the plane); 3 is flexion, 4 torsion. Of a freedom 0.
    pub about: usize,
    /// What of it.
    pub what: JointQuantity,
}

impl OfLaw for JointOutput {
    fn exists_in_plane(&self) -> bool {
        self.about == 1
    }
}

/// Of a relative rotation.
const OF_JOINT: [(&str, &str, JointQuantity); 5] = [
    ("torque", "N*m", JointQuantity::Torque),
    ("angle", "rad", JointQuantity::Angle),
    ("rate", "rad/s", JointQuantity::Rate),
    ("permanent_set_above", "rad", JointQuantity::SetAbove),
    ("permanent_set_below", "rad", JointQuantity::SetBelow),
];

/// Of the law of a freedom that turns, and of one that slides.
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
        let what = Asked::Joint(JointOutput { about, what });
        Some((Quantity::OfForce { force, what }, unit))
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
        let what = Asked::Joint(JointOutput { about: 0, what });
        Some((Quantity::OfForce { force, what }, unit))
    }
}

/// Reports the keys that mean nothing for the scalars of a joint.
fn of_joint(resolver: &Resolver<'_>, at: At<'_>) {
    resolver.without(at, &["segment", "ring"], "anything but a belt");
    let keys = ["at", "component", "axes", "relative_to", "on"];
    resolver.without(at, &keys, "the scalars of a joint");
}

/// Of a joint about one relative rotation.
#[derive(Clone, Copy)]
pub struct JointMeasures<'g> {
    /// Generalised torque on the child \[N m\].
    pub torque: Expr<'g>,
    /// Relative angle \[rad\].
    pub angle: Expr<'g>,
    /// Its rate \[rad/s\].
    pub rate: Expr<'g>,
    /// The angles beyond and before the neutral one at which the elastic torque ends that falls from here \[rad\]; 0 without hysteresis.
    pub permanent_sets: [Expr<'g>; 2],
}

/// Of a joint: per relative rotation, then of flexion and of torsion, where a law acts or somebody looks.
pub type AboutRotations<'g> = [Option<JointMeasures<'g>>; 5];

impl<'g> Measures<'g> for AboutRotations<'g> {
    fn value(&self, asked: &Asked) -> Option<Value<'g>> {
        let Asked::Joint(JointOutput { about, what }) = asked else {
            return None;
        };
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
