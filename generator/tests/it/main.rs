//! The generator as its users call it, in one program, so that it is linked once.

mod config;
mod derivatives;
mod effects;
mod emission;
mod imports;
mod joined;
mod joints;
mod language;
mod link;
mod malformed;
mod methods;
mod parameters;
mod placement;
mod reference;
#[path = "../../../tests/suite/share.rs"]
mod share;
mod short;
mod texts;
mod units;
mod urdf;
mod user;
