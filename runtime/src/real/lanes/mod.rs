//! Several scenarios side by side, one in each lane of a register.
//!
//! | file | what |
//! |---|---|
//! | `register` | what a register can do |
//! | `single` | one double as a register |

pub mod register;
pub mod single;
