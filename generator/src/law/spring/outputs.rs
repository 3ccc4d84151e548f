//! Outputs of a spring.

use super::keys::Spring;
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{Measures, Value};
use crate::model::Quantity;
use crate::model::law::{OfLaw, Visible};
use crate::model::look::{Line, Look};
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::resolve::output::has_direction;
use serde::Serialize;

/// A quantity of a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum SpringQuantity {
    /// Force, positive where it pulls \[N\].
    Force,
    /// Distance of the attachments \[m\].
    Length,
    /// Length less the length at which the elongation is 0 \[m\].
    Elongation,
    /// Rate of the length \[m/s\].
    Rate,
}

impl OfLaw for SpringQuantity {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }
}

const TABLE: [(&str, &str, SpringQuantity); 4] = [
    ("force", "N", SpringQuantity::Force),
    ("length", "m", SpringQuantity::Length),
    ("elongation", "m", SpringQuantity::Elongation),
    ("rate", "m/s", SpringQuantity::Rate),
];

impl Outputs for Spring {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        resolver.of_law(at, "a spring");
        let (what, unit) = resolver.look_up(written, &TABLE, "a spring", at)?;
        let quantity = match what {
            SpringQuantity::Force if has_direction(written) => {
                resolver.force_on(written, force, [self.from.on, self.to.on], at)?
            }
            what => resolver.scalar(force, what, at),
        };
        Some((quantity, unit))
    }
}

impl Visible for Spring {
    fn looks(&self) -> Vec<Look<'_>> {
        vec![Look::Line(Line::Spring, vec![&self.from, &self.to])]
    }
}

/// Expressions of the quantities of a spring.
#[derive(Clone, Copy)]
pub struct SpringMeasures<'g> {
    /// The force on the body of the end `from` \[N\].
    pub on_first: Vec3<'g>,
    /// Force, positive where it pulls \[N\].
    pub force: Expr<'g>,
    /// Distance of the attachments \[m\].
    pub length: Expr<'g>,
    /// Length less the length at which the elongation is 0 \[m\].
    pub elongation: Expr<'g>,
    /// Rate of the length \[m/s\].
    pub rate: Expr<'g>,
}

impl<'g> Measures<'g> for SpringMeasures<'g> {
    fn on(&self) -> Vec<Vec3<'g>> {
        vec![self.on_first]
    }

    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let what = asked.get::<SpringQuantity>()?;
        Some(Value::Scalar(match what {
            SpringQuantity::Force => self.force,
            SpringQuantity::Length => self.length,
            SpringQuantity::Elongation => self.elongation,
            SpringQuantity::Rate => self.rate,
        }))
    }
}
