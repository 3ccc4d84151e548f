//! The powers of laws, by effect, for the balance of energy.

use super::AppliedForces;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::model::ElementId;

/// The power of one effect.
pub struct Work<'g> {
    /// Name for people: "contact seat: friction".
    pub name: String,
    /// The power is the sum of these products. They are multiplied after all other expressions are made, so that the
    /// energy balance does not change the equations.
    pub products: Vec<Product<'g>>,
}

/// The two factors of a power.
#[derive(Clone, Copy)]
pub enum Product<'g> {
    /// A torque and a rate, a tension and the rate of a length.
    Scalars(Expr<'g>, Expr<'g>),
    /// A force and a velocity, a moment and an angular velocity.
    Vectors(Vec3<'g>, Vec3<'g>),
    /// The acceleration of a field, and the element whose momentum is the other factor.
    Field(Vec3<'g>, ElementId),
}

impl<'g> AppliedForces<'g> {
    /// Adds a power to the effect of this name.
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
