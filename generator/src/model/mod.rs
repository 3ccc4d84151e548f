//! The resolved model: indices instead of names, SI instead of units, every reference and every number checked.
//!
//! `description` holds what the user wrote, this module what it means. A [`Model`] can only be had from
//! [`read`](crate::read()) and [`read_str`](crate::read_str), which report every problem they find. Every [`Model`] has
//! these properties: each system is one tree with carriers before what they carry; names are unique; masses are
//! positive and inertias realisable at the default parameters; all numbers are finite; curves have increasing
//! abscissae; every index is in range; and the mass matrix is not structurally singular.

mod body;
mod coefficient;
mod criteria;
mod curve;
pub mod declared;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod digest;
mod dimension;
mod force;
pub mod joint;
pub mod law;
pub mod look;
mod mechanism;
mod normal;
mod number;
mod numbers;
mod output;
mod over_time;
pub mod part;
pub mod placement;
mod quantity;
pub(crate) mod requirement;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
pub mod annotated_model;
#[doc(hidden)]
pub mod resolve;
pub mod rule;
mod surface;
mod switch;
mod system;
mod thinning;
pub mod units;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod unloading;

pub use crate::description::joint::Coordinate;
pub use body::{Attachment, Body, ElementId};
pub use coefficient::{Bristle, FieldComponent, Friction, Hysteresis};
pub use criteria::Criteria;
pub use curve::{Curve, Extrapolate, Interpolate, ScaledCurve, Thinned};
pub use dimension::{Coordinates, Dimension};
pub use force::Force;
pub use joint::{Follows, Freedom, FreedomKind, Joint};
pub use law::{Law, OfLaw};
pub use mechanism::{Model, Parameter, Run};
pub use number::Number;
pub use output::{Channel, Output};
pub use quantity::{
    Component, Formula, FreedomQuantity, JointLoadQuantity, Leaf, PointQuantity, Projection,
    Quantity, RotationQuantity, SwitchQuantity, SystemQuantity,
};
pub use requirement::Requirement;
pub use rule::Rule;
pub use surface::{EdgeRule, Ellipsoid, Extent, Mesh, Plane, Round, Shown, Triangles};
pub use switch::{Active, Switch, Trigger};
pub use system::{Element, Given, NamedPoint, Reference, System, Translation, Vehicle};
pub use units::Units;
