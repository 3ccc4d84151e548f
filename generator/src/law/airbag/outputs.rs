//! Outputs of an airbag: of its gas, and of its force on a body.

use super::check::Airbag;
use crate::description::output::Output as Written;
use crate::description::place::At;
use crate::expression::Expr;
use crate::expression::vector::Vec3;
use crate::force::{ContactPoint, Measures, Value};
use crate::law::contact::force::Touch;
use crate::model::law::{OfLaw, Visible};
use crate::model::look::Look;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::Outputs;
use crate::model::{Body, Quantity};
use serde::Serialize;

/// A quantity of an airbag.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum AirbagQuantity {
    /// Absolute pressure \[Pa\].
    Pressure,
    /// Temperature \[K\].
    Temperature,
    /// Mass of gas \[kg\].
    Mass,
    /// Volume of gas \[m³\].
    Volume,
    /// Mass flow out \[kg/s\].
    Outflow,
    /// Total area that pushes on the bodies that the bag meets \[m²\].
    Area,
}

impl OfLaw for AirbagQuantity {
    fn boxed(&self) -> Box<dyn OfLaw> {
        Box::new(*self)
    }
}

/// Name, unit and quantity; `None` for the force, which also has a direction.
const TABLE: [(&str, &str, Option<AirbagQuantity>); 7] = [
    ("force", "N", None),
    ("pressure", "Pa", Some(AirbagQuantity::Pressure)),
    ("temperature", "K", Some(AirbagQuantity::Temperature)),
    ("mass", "kg", Some(AirbagQuantity::Mass)),
    ("volume", "m^3", Some(AirbagQuantity::Volume)),
    ("outflow", "kg/s", Some(AirbagQuantity::Outflow)),
    ("area", "m^2", Some(AirbagQuantity::Area)),
];

impl Outputs for Airbag {
    fn output(
        &self,
        resolver: &Resolver<'_>,
        written: &Written,
        force: usize,
        at: At<'_>,
    ) -> Option<(Quantity, &'static str)> {
        resolver.of_law(at, "an airbag");
        let (what, unit) = resolver.look_up(written, &TABLE, "an airbag", at)?;
        let quantity = match what {
            Some(what) => resolver.scalar(force, what, at),
            None => {
                let bodies: Vec<Body> = self.ellipsoids().map(|e| e.center.on).collect();
                resolver.on_points(written, force, &bodies, at)?
            }
        };
        Some((quantity, unit))
    }
}

impl Visible for Airbag {
    fn looks(&self) -> Vec<Look<'_>> {
        let bag = Look::Bag(self.ellipsoid.round(), Box::new(AirbagQuantity::Volume));
        let others = self.against.iter().map(|other| Look::Round(other.round()));
        std::iter::once(bag).chain(others).collect()
    }
}

/// Expressions of the quantities of an airbag.
pub struct AirbagMeasures<'g> {
    /// The force on the body of the bag, and on each that it meets \[N\].
    pub on: Vec<Vec3<'g>>,
    /// Absolute pressure \[Pa\].
    pub pressure: Expr<'g>,
    /// Temperature \[K\].
    pub temperature: Expr<'g>,
    /// Mass of gas \[kg\].
    pub mass: Expr<'g>,
    /// Volume of the gas \[m³\].
    pub volume: Expr<'g>,
    /// Mass flow out \[kg/s\].
    pub outflow: Expr<'g>,
    /// Total area that pushes \[m²\].
    pub area: Expr<'g>,
    /// For each ellipsoid that the bag meets, its name and how it touches the bag, which is the first body.
    pub names: Vec<String>,
    pub(crate) touches: Vec<Touch<'g>>,
}

impl<'g> Measures<'g> for AirbagMeasures<'g> {
    fn on(&self) -> Vec<Vec3<'g>> {
        self.on.clone()
    }

    fn contact_points(&self) -> Vec<ContactPoint<'g>> {
        let (of, pushes) = (self.names.iter().zip(&self.touches), &self.on[1..]);
        of.zip(pushes)
            .map(|((name, touch), push)| touch.point(name.clone(), -*push, None))
            .collect()
    }

    fn value(&self, asked: &dyn OfLaw) -> Option<Value<'g>> {
        let what = asked.get::<AirbagQuantity>()?;
        Some(Value::Scalar(match what {
            AirbagQuantity::Pressure => self.pressure,
            AirbagQuantity::Temperature => self.temperature,
            AirbagQuantity::Mass => self.mass,
            AirbagQuantity::Volume => self.volume,
            AirbagQuantity::Outflow => self.outflow,
            AirbagQuantity::Area => self.area,
        }))
    }
}
