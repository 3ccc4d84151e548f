//! The keys of an airbag.

use super::check::{self, Jet, NeverNegative};
use crate::description::measure::{
    Area, GasConstant, MassFlow, NotNegative, Positive, Pressure, Pure, Temperature, Time,
};
use crate::description::quantity::Number;
use crate::description::shape::record;
use crate::model::Ellipsoid;
use crate::model::declared::{
    Checked, CurveOf, Declared, DeclaredLaw, OrDefault, Present, Reader, Required, SwitchName,
    Written, declare,
};
use crate::model::resolve::law::{TitledKeys, record};

/// The keys of an airbag.
pub type AirbagKeys = Written<Airbag>;

declare! {
    /// A bag that gas fills, and that pushes what it meets. Its gas has one pressure.
    Airbag as "an airbag" only written {
        /// name, unique among the airbags
        airbag: String,
        /// `false` leaves the force out
        enabled: Option<bool> = "`true`",
        /// `true` adds its [mirror image](#a-mirror)
        mirror: Option<bool> = "`false`",
    } and kept {
        /// its [shape](#an-ellipsoid) when full, in place or by the [name of a surface](#named-surfaces)
        ellipsoid: Ellipsoid,
        /// a list of the ellipsoids that it meets, on other bodies: in place, or by the names of surfaces and groups
        against: Vec<Ellipsoid>,
        /// [what the gas is](#a-gas), of bag and inflow
        gas: Present<Gas> = "air",
        /// [the air](#the-air-around-a-bag) around the bag
        ambient: Present<Ambient> = "101 325 Pa, 293.15 K",
        /// [gas that flows in](#an-inflow)
        inflow: Option<Inflow>,
        /// the [gas](#the-gas-of-a-full-bag) of a bag that is full at the start. Without it a thousandth of the volume
        /// is filled with ambient air
        start: Option<Filled> as "gas at the start" = "folded",
        /// [a hole](#a-vent) through which gas flows out
        vent: Jet as "vent" needs "there is no gas",
    }
}

declare! {
    /// A source of gas.
    Inflow as "an inflow" {
        /// the [switch](#a-switch) that fires it
        fire: SwitchName,
        /// mass of gas per time, against the time since then; never negative
        flow: Checked<CurveOf<Time, MassFlow>, NeverNegative>,
        /// absolute temperature of that gas
        temperature: Required<Positive<Temperature>>,
    }
}

impl Declared for Inflow {}

declare! {
    /// A perfect gas.
    Gas as "a gas" {
        /// gas constant R
        constant: OrDefault<Positive<GasConstant>> = "287",
        /// ratio of specific heats γ, more than 1
        gamma: OrDefault<Positive<Pure>> = "1.4",
    }
}

impl Declared for Gas {}

declare! {
    /// The air around a bag, and the little gas in it before the inflow begins.
    Ambient as "the air around a bag" {
        /// absolute pressure
        pressure: OrDefault<Positive<Pressure>> = "101325 Pa",
        /// absolute temperature
        temperature: OrDefault<Positive<Temperature>> = "293.15 K",
    }
}

impl Declared for Ambient {}

declare! {
    /// The gas of a bag that is full at the start.
    Filled as "the gas of a full bag" {
        /// absolute pressure, at least that around the bag
        pressure: Required<Positive<Pressure>>,
        /// absolute temperature
        temperature: Required<Positive<Temperature>>,
    }
}

impl Declared for Filled {}

record! {
    /// A hole that gas flows out of.
    Vent as "a vent" {
        /// its area
        area: Number<NotNegative<Area>>,
        /// share of the area that the jet fills (discharge coefficient)
        coefficient: Option<Number<Pure>> = "1",
    }
}

impl DeclaredLaw for Airbag {
    const KEY: &'static str = "airbag";
    const RECORDS: &'static [fn() -> TitledKeys] = &[
        record::<Written<Inflow>>,
        record::<Written<Gas>>,
        record::<Vent>,
        record::<Written<Ambient>>,
        record::<Written<Filled>>,
    ];

    fn check_keys(name: &str, reader: &Reader<'_, '_, '_>) {
        check::check_keys(name, reader);
    }

    fn check(self, name: &str, reader: &mut Reader<'_, '_, '_>) -> Option<Self> {
        check::check_bodies(&self, name, reader);
        // a flow that is 0 everywhere is none, and a folded bag without one does nothing
        (self.inflow.is_some() || self.start.is_some()).then_some(self)
    }
}
