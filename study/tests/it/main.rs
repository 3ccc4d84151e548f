//! Studies as their users run them, in one program, so that it is linked once.

mod common;
mod killed;
mod reference;
mod running;
mod summary;
mod units;
