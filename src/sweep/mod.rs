//! Studies of a model: runs the rows of `bryant-study` in lanes.
//!
//! | file | what |
//! |---|---|
//! | `plan` | the settings of a study for the runtime: duration, accuracy, responses |
//! | `engine` | runs rows of a model |
//! | `stiff_row` | runs a row of a stiff scene alone |
//! | `refusal` | why a row of parameters is refused, or why its run cannot be trusted |
//! | `inputs` | the data that a folder of results needs for merging |

mod engine;
mod inputs;
mod stiff_row;
// Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
#[doc(hidden)]
pub mod plan;
mod refusal;

pub use engine::{FEW, Lanes};
pub use inputs::{Kept, KeptError, keep};
pub use plan::{job, response_of};
pub use refusal::{doubt, refusal};
pub use stiff_row::{Alone, alone};
