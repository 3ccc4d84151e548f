//! People as systems of a model: adults by sex, stature and mass; crash dummies and children by name.
//!
//! | file | what |
//! |---|---|
//! | `data` | segments (`segments.json`) and outer dimensions (`outside.json`), with their sources |
//! | `dummy` | masses and dimensions of crash dummies and of children (`dummies.json`) |
//! | `body` | the construction: elements and ellipsoids |
//! | `size` | sizes by name and by percentile |
//! | `posture` | angles of joints by posture |
//! | `text` | the system as YAML |
//!
//! All coordinates are 0 for a body that stands upright: x forward, y to the left, z up. All frames are then parallel.
//! The origin of an element is its joint on the carrying element; that of the pelvis is midway between the hips.

mod body;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod data;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod dummy;
mod posture;
// Public for the tests in `tests/it`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod size;
mod text;

pub use body::{Body, Element, Shape, body};
pub use data::Sex;
pub(crate) use data::read;
pub use posture::{JOINTS, Posture};
pub use size::{NAMES, Person, Size};
pub use text::{Neutral, Written, yaml};
