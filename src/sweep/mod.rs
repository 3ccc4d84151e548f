//! Studies of a model: what `bryant-study` asks to be run, run in lanes.
//!
//! | file | what |
//! |---|---|
//! | `plan` | a study in the words of the runtime: how long, how accurate, which responses |
//! | `engine` | a model as what runs rows |
//! | `refusal` | why a row of parameters is refused, or its run not to be trusted |
//! | `kept` | what a folder of results needs to be merged without anything else |

mod engine;
mod kept;
mod plan;
mod refusal;

pub use engine::Lanes;
pub use kept::{Kept, KeptError, keep};
pub use plan::{job, response_of};
pub use refusal::{doubt, refusal};
