//! Airbags: an ellipsoid of gas at one pressure, and what it meets.

use crate::model::{Ellipsoid, Number, ScaledCurve};

/// Part of the volume of a bag that gas takes at the start, where it is not full.
pub const FOLDED: f64 = 1e-3;

/// A bag of gas at one pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct Airbag {
    /// Its shape when full.
    pub bag: Ellipsoid,
    /// What it meets, on other bodies.
    pub against: Vec<Ellipsoid>,
    /// Gas that flows in.
    pub inflow: Option<Inflow>,
    /// Area of the jet that flows out, that of the hole times its coefficient \[m²\].
    pub vent: Option<Number>,
    /// Gas constant \[J/(kg K)\].
    pub constant: Number,
    /// Ratio of specific heats, more than 1.
    pub gamma: Number,
    /// Absolute pressure around it \[Pa\].
    pub ambient_pressure: Number,
    /// Temperature of what little gas is in it before it fires \[K\].
    pub ambient_temperature: Number,
    /// Its gas at the start, where it is full then.
    pub start: Option<Filled>,
}

/// A source of gas.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow {
    /// Index into [`Model::switches`](crate::model::Model::switches).
    pub fire: usize,
    /// Mass flow against the time since then \[s\] → \[kg/s\].
    pub flow: ScaledCurve,
    /// Temperature of the gas \[K\].
    pub temperature: Number,
}

/// The gas of a full bag.
#[derive(Clone, Debug, PartialEq)]
pub struct Filled {
    /// Absolute pressure \[Pa\].
    pub pressure: Number,
    /// Temperature \[K\].
    pub temperature: Number,
}

/// Of an airbag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AirbagQuantity {
    /// Absolute pressure \[Pa\].
    Pressure,
    /// Temperature \[K\].
    Temperature,
    /// Mass of gas \[kg\].
    Mass,
    /// Volume of gas \[m³\].
    Volume,
    /// Mass that flows out \[kg/s\].
    Outflow,
    /// Area that pushes what it meets, all together \[m²\].
    Area,
}

impl Airbag {
    /// Its ellipsoid and those that it meets.
    pub fn ellipsoids(&self) -> impl Iterator<Item = &Ellipsoid> {
        std::iter::once(&self.bag).chain(&self.against)
    }

    /// The same, to be changed.
    pub fn ellipsoids_mut(&mut self) -> impl Iterator<Item = &mut Ellipsoid> {
        std::iter::once(&mut self.bag).chain(&mut self.against)
    }
}
