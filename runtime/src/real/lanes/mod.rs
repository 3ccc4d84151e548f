//! Several scenarios side by side, one in each lane of a register.
//!
//! | file | what |
//! |---|---|
//! | `register` | what a register can do |
//! | `single` | one double as a register |
//! | `elementary` | sine, exponential and their like, over any register |

pub mod elementary;
pub mod register;
pub mod single;
