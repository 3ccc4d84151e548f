//! Adults by sex, stature and mass, as a system of a model.
//!
//! | file | what |
//! |---|---|
//! | `data` | segments (`segments.json`) and outer dimensions (`outside.json`), with their sources |
//! | `body` | the construction: elements and ellipsoids |
//! | `size` | sizes by name and by percentile |
//! | `text` | the system as YAML |
//!
//! A body stands upright where all coordinates are 0: x forward, y to the left, z up, every frame parallel to the others, its origin at the joint on the element inboard,
//! that of the pelvis midway between the hips.

mod body;
mod data;
mod size;
mod text;

pub use body::{Body, Element, Shape, body};
pub use data::Sex;
pub use size::{NAMES, Size};
pub use text::{Posture, yaml};
