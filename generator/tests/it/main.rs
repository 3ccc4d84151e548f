//! The generator as its users call it, in one program, so that it is linked once.

mod config;
mod derivatives;
mod effects;
mod emission;
mod imports;
mod joined_lists;
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
mod short_forms;
mod texts;
mod units;
mod urdf;
mod user;
