//! The powers of laws, by effect, for the balance of energy.

use super::AppliedForces;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::ElementId;

/// How one effect does work.
pub struct Work<'g> {
    /// Name for people: "contact seat: friction".
    pub name: String,
    /// Its power is their sum. Kept apart until everything else is derived, so that the balance of energy leaves no trace
    /// in the equations.
    pub products: Vec<Product<'g>>,
}

/// A factor of a power and the other.
#[derive(Clone, Copy)]
pub enum Product<'g> {
    /// A torque and a rate, a tension and the rate of a length.
    Scalars(Expr<'g>, Expr<'g>),
    /// A force and a velocity, a moment and an angular velocity.
    Vectors(Vec3<'g>, Vec3<'g>),
    /// A field's acceleration and the momentum of an element that feels it.
    Field(Vec3<'g>, ElementId),
}

impl<'g> AppliedForces<'g> {
    /// Counts a power to an effect.
    pub fn work(&mut self, name: impl Into<String>, product: Product<'g>) {
        let name = name.into();
        match self.works.iter_mut().find(|work| work.name == name) {
            Some(work) => work.products.push(product),
            None => self.works.push(Work {
                name,
                products: vec![product],
            }),
        }
    }
}
