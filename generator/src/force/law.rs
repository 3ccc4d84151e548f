//! A law as the equations know it.

use super::AppliedForces;
use super::switch::Gate;
use crate::expression::vector::Vec3;
use crate::expression::{Expr, Graph};
use crate::model::law::OfLaw;
use crate::model::{Model, Projection};
use crate::motion::Motion;

/// The equations of a law: it becomes forces and moments on bodies.
pub trait Equations {
    /// Applies the law to the bodies, and returns its measures.
    fn apply<'g>(
        &self,
        setting: Setting<'_, 'g>,
        applied: &mut AppliedForces<'g>,
    ) -> Box<dyn Measures<'g> + 'g>;

    /// An expression that must not be negative for the law to make sense in a run that starts with this motion, and its
    /// text in messages.
    fn condition<'g>(
        &self,
        _graph: &'g Graph,
        _start: &Motion<'g>,
        _name: &str,
    ) -> Option<(String, Expr<'g>)> {
        None
    }
}

/// The surroundings in which a law is applied.
#[derive(Clone, Copy)]
pub struct Setting<'a, 'g> {
    /// The graph in which expressions are made.
    pub graph: &'g Graph,
    /// The whole model.
    pub model: &'a Model,
    /// The motion of the model.
    pub motion: &'a Motion<'g>,
    /// The motion of the model at the start of a run.
    pub start: &'a Motion<'g>,
    /// Index of the force in the model.
    pub index: usize,
    /// Name of the force.
    pub name: &'a str,
    /// Condition under which the force acts.
    pub gate: Gate<'g>,
}

/// Expressions of the quantities of a law.
pub trait Measures<'g> {
    /// The force on each point of the law \[N\], for [`Quantity::ForceOn`](crate::model::Quantity::ForceOn) and
    /// [`Quantity::ForceOnPoints`](crate::model::Quantity::ForceOnPoints).
    fn on(&self) -> Vec<Vec3<'g>> {
        Vec::new()
    }

    /// Where surfaces push each other, or may. The expressions are made when they are asked for.
    fn contact_points(&self) -> Vec<ContactPoint<'g>> {
        Vec::new()
    }

    /// A quantity of the law.
    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>>;
}

/// The measures of a law without outputs.
impl<'g> Measures<'g> for () {
    fn value(&self, _: &dyn OfLaw) -> Option<Value<'g>> {
        None
    }
}

/// A place where two surfaces push each other, or may.
pub struct ContactPoint<'g> {
    /// Name for people: "seat", "bag on head".
    pub name: String,
    /// Positive while the surfaces are apart, negative while they overlap \[m\].
    pub gap: Expr<'g>,
    /// The point where the force acts, in absolute axes; while the surfaces are apart, where they are nearest \[m\].
    pub place: Vec3<'g>,
    /// Unit vector from the second body to the first, in absolute axes.
    pub normal: Vec3<'g>,
    /// The force on the first body, in absolute axes \[N\].
    pub force: Vec3<'g>,
}

/// The value of a quantity of a law.
pub enum Value<'g> {
    /// A number.
    Scalar(Expr<'g>),
    /// A component, or the magnitude, of a vector in absolute axes.
    Along(Projection, Vec3<'g>),
}
