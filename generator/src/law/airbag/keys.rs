//! The keys of an airbag.

use crate::description::curve::FunctionOf;
use crate::description::expand::{Expander, Node};
use crate::description::measure::{Area, GasConstant, MassFlow, Pressure, Pure, Temperature, Time};
use crate::description::place::At;
use crate::description::quantity::Number;
use crate::description::shape::{Key, record};
use crate::description::short::ByName;
use crate::description::surface::Ellipsoid;
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Keys, record};

record! {
    /// A bag that gas fills, and that pushes what it meets.
    Airbag as "an airbag" {
        /// name, unique among the airbags
        airbag: String,
        /// `false` leaves the force out
        enabled: Option<bool> = "`true`",
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
        /// its [shape](#an-ellipsoid) when full, in place or by the [name of a surface](#named-surfaces)
        ellipsoid: ByName<Ellipsoid>,
        /// a list of the ellipsoids that it meets, on other bodies: in place, or by the names of surfaces and groups
        against: Vec<ByName<Ellipsoid>>,
        /// [gas that flows in](#an-inflow)
        inflow: Option<Inflow>,
        /// [what the gas is](#a-gas), of bag and inflow
        gas: Option<Gas> = "air",
        /// [a hole](#a-vent) through which gas flows out
        vent: Option<Vent>,
        /// [the air](#the-state-of-a-gas) around the bag
        ambient: Option<Air> = "101 325 Pa, 293.15 K",
        /// the [gas](#the-state-of-a-gas) of a bag that is full at the start; give both of its numbers. Without it a
        /// thousandth of the volume is filled with ambient air
        start: Option<Air> = "folded",
    }
}

record! {
    /// A source of gas.
    Inflow as "an inflow" {
        /// the [switch](#a-switch) that fires it
        fire: String,
        /// mass of gas per time, against the time since then; never negative
        flow: FunctionOf<Time, MassFlow>,
        /// absolute temperature of that gas
        temperature: Number<Temperature>,
    }
}

record! {
    /// A perfect gas.
    Gas as "a gas" {
        /// gas constant R
        constant: Option<Number<GasConstant>> = "287",
        /// ratio of specific heats γ, more than 1
        gamma: Option<Number<Pure>> = "1.4",
    }
}

record! {
    /// A hole that gas flows out of.
    Vent as "a vent" {
        /// its area
        area: Number<Area>,
        /// share of the area that the jet fills (discharge coefficient)
        coefficient: Option<Number<Pure>> = "1",
    }
}

record! {
    /// A state of a gas.
    Air as "the state of a gas" {
        /// absolute pressure
        pressure: Option<Number<Pressure>> = "101 325 Pa around a bag",
        /// absolute temperature
        temperature: Option<Number<Temperature>> = "293.15 K around a bag",
    }
}

impl Keys for Airbag {
    const KEY: &'static str = "airbag";

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::airbag(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, Vec<Key>)> {
        vec![
            record::<Airbag>(),
            record::<Inflow>(),
            record::<Gas>(),
            record::<Vent>(),
            record::<Air>(),
        ]
    }

    fn mirror(expander: &Expander<'_>, image: &mut Node) {
        image.change("ellipsoid", |bag| expander.mirrored_by_name(bag));
        expander.mirrored_list(image, "against");
    }
}
