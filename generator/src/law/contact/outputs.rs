//! Outputs of a contact.

use super::check::{Against, Contact};
use super::force::Touch;
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{ContactPoint, Measures, Value};
use crate::model::Quantity;
use crate::model::Round;
use crate::model::law::{OfLaw, Visible};
use crate::model::look::Look;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::resolve::output::has_direction;
use serde::Serialize;

/// A quantity of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum ContactQuantity {
    /// Resultant force \[N\].
    Force,
    /// Normal force \[N\].
    Normal,
    /// Friction force \[N\].
    Friction,
    /// Penetration, negative while apart \[m\].
    Penetration,
    /// Foot of the unloading line \[m\]; 0 without hysteresis.
    PermanentSet,
}

impl OfLaw for ContactQuantity {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }
}

const TABLE: [(&str, &str, ContactQuantity); 5] = [
    ("force", "N", ContactQuantity::Force),
    ("normal", "N", ContactQuantity::Normal),
    ("friction", "N", ContactQuantity::Friction),
    ("penetration", "m", ContactQuantity::Penetration),
    ("permanent_set", "m", ContactQuantity::PermanentSet),
];

impl Outputs for Contact {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        resolver.of_law(at, "a contact");
        let (what, unit) = resolver.look_up(written, &TABLE, "a contact", at)?;
        let quantity = match what {
            ContactQuantity::Force if has_direction(written) => {
                let bodies = [self.ellipsoid.center.on, self.against.place().on];
                resolver.force_on(written, force, bodies, at)?
            }
            what => resolver.scalar(force, what, at),
        };
        Some((quantity, unit))
    }
}

impl Visible for Contact {
    fn looks(&self) -> Vec<Look<'_>> {
        let round = Round {
            degree: self.degree,
            ..self.ellipsoid.round()
        };
        let other = match &self.against {
            Against::Plane(plane) => Look::Plane(plane, Some(round)),
            Against::Ellipsoid(ellipsoid) => Look::Round(ellipsoid.round()),
        };
        let push = Look::Push(round, self.against.plane());
        vec![Look::Round(round), other, push]
    }
}

/// Expressions of the quantities of a contact.
pub struct ContactMeasures<'g> {
    /// The whole force on the body of the contact's `ellipsoid` \[N\].
    pub on_first: Vec3<'g>,
    /// Magnitude of the whole force \[N\].
    pub force: Expr<'g>,
    /// Normal force \[N\].
    pub normal: Expr<'g>,
    /// Magnitude of the friction force \[N\]; signed in the plane.
    pub friction: Expr<'g>,
    /// Penetration \[m\].
    pub penetration: Expr<'g>,
    /// Penetration at which the force on the unloading line is 0 \[m\]; 0 without hysteresis.
    pub permanent_set: Expr<'g>,
    /// Name of the contact.
    pub name: String,
    /// Where the surfaces touch.
    pub(crate) touch: Touch<'g>,
    /// Positive if the deepest point is inside the edges of a plane \[m\]; `None` without edges.
    pub inside: Option<Expr<'g>>,
}

impl<'g> Measures<'g> for ContactMeasures<'g> {
    fn on(&self) -> Vec<Vec3<'g>> {
        vec![self.on_first]
    }

    fn contact_points(&self) -> Vec<ContactPoint<'g>> {
        vec![
            self.touch
                .point(self.name.clone(), self.on_first, self.inside),
        ]
    }

    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let what = asked.get::<ContactQuantity>()?;
        Some(Value::Scalar(match what {
            ContactQuantity::Force => self.force,
            ContactQuantity::Normal => self.normal,
            ContactQuantity::Friction => self.friction,
            ContactQuantity::Penetration => self.penetration,
            ContactQuantity::PermanentSet => self.permanent_set,
        }))
    }
}
