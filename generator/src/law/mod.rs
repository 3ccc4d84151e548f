//! The force laws, a folder for each.

pub mod airbag;
pub mod belt;
pub mod contact;
pub mod field;
pub mod joint;
pub mod load;
pub mod spring;
pub mod user;
