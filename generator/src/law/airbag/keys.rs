//! The keys of an airbag.

use crate::description::curve::Function;
use crate::description::expand::{Expander, Node};
use crate::description::place::At;
use crate::description::quantity::Quantity;
use crate::description::shape::{Key, record};
use crate::description::short::ByName;
use crate::description::surface::Ellipsoid;
use crate::model::law::Law;
use crate::model::resolve::Resolver;
use crate::model::resolve::law::{Header, Keys, record};

record! {
    /// A bag that gas fills, and that pushes what it meets.
    Airbag as "an airbag" {
        /// Name, unique among the airbags.
        airbag: String,
        /// Whether it acts.
        enabled: Option<bool>,
        /// Whether it has a mirror image.
        mirror: Option<bool>,
        /// Its shape when full.
        ellipsoid: ByName<Ellipsoid>,
        /// What it meets, by names of ellipsoids or groups, or in place.
        against: Vec<ByName<Ellipsoid>>,
        /// Gas that flows in.
        inflow: Option<Inflow>,
        /// What the gas is.
        gas: Option<Gas>,
        /// Where it flows out.
        vent: Option<Vent>,
        /// What is around it.
        ambient: Option<Air>,
        /// Of a bag that is full at the start: its gas.
        start: Option<Air>,
    }
}

record! {
    /// A source of gas.
    Inflow as "an inflow" {
        /// The switch that fires it.
        fire: String,
        /// Mass of gas per time against the time since then \[s\] → \[kg/s\].
        flow: Function,
        /// Its absolute temperature \[K\].
        temperature: Quantity,
    }
}

record! {
    /// A perfect gas.
    Gas as "a gas" {
        /// R \[J/(kg K)\].
        constant: Option<Quantity>,
        /// Ratio of its specific heats.
        gamma: Option<Quantity>,
    }
}

record! {
    /// A hole that gas flows out of.
    Vent as "a vent" {
        /// Its area \[m²\].
        area: Quantity,
        /// Part of the area that the jet takes.
        coefficient: Option<Quantity>,
    }
}

record! {
    /// A state of a gas.
    Air as "the state of a gas" {
        /// Absolute pressure \[Pa\].
        pressure: Option<Quantity>,
        /// Absolute temperature \[K\].
        temperature: Option<Quantity>,
    }
}

impl Keys for Airbag {
    const KEY: &'static str = "airbag";

    fn header(&self) -> Header<'_> {
        Header {
            name: self.airbag.clone(),
            called: Some((Self::KEY, &self.airbag)),
            enabled: self.enabled,
            since: None,
            until: None,
        }
    }

    fn check(&self, resolver: &mut Resolver<'_>, at: At<'_>) -> Option<Box<dyn Law>> {
        super::check::airbag(resolver, self, at).map(|law| Box::new(law) as Box<dyn Law>)
    }

    fn records() -> Vec<(&'static str, &'static [Key])> {
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
