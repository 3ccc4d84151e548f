//! The motion of every body as a function of q and v: position, orientation and velocity, and the acceleration that
//! remains when v̇ = 0.
//!
//! | file | content |
//! |---|---|
//! | `numbers` | numbers of the model as expressions; rotations |
//! | `layout` | the coordinates and velocities, their order, and q̇ |
//! | `variables` | the coordinates and velocities of one joint |
//! | `element` | the motion of one body |
//! | `ball`, `chart`, `twist` | an element on a ball joint, with Bryant angles in two charts; on freedoms |
//! | `free`, `prescribed_joint`, `vehicle`, `translation` | reference joints, vehicles and their prescribed motion |
//! | `kinematics` | the motion of all bodies, from the root of each tree to its leaves |
//!
//! Nothing here knows of masses and forces.

pub mod ball;
pub mod chart;
pub mod element;
pub(crate) mod free;
pub mod kinematics;
pub mod layout;
pub(crate) mod numbers;
pub(crate) mod prescribed_joint;
pub(crate) mod translation;
pub(crate) mod twist;
pub(crate) mod variables;
pub(crate) mod vehicle;

pub use element::ElementMotion;
pub use kinematics::{Motion, Point};
pub use layout::{Layout, State};
