//! People as systems of a model: adults by sex, stature and mass, crash dummies and children by name.
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
//! A body stands upright where all coordinates are 0: x forward, y to the left, z up, every frame parallel to the others, its origin at the joint on the element inboard,
//! that of the pelvis midway between the hips.

mod body;
mod data;
mod dummy;
mod posture;
mod size;
mod text;

pub use body::{Body, Element, Shape, body};
pub use data::Sex;
pub use posture::{JOINTS, Posture};
pub use size::{NAMES, Person, Size};
pub use text::{Written, yaml};
