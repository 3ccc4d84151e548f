//! The store of results: a folder that any number of processes may fill, and that never has partial results.
//!
//! ```text
//! study.json            the identity of the results
//! blocks/00000017.part  results of a block of rows; complete if the file exists
//! series/run-….csv      time series of runs that are kept
//! study/                the study and the facts about its model, kept for merging
//! results.parquet, …    the table, once all blocks exist
//! ```

pub mod folder;
pub mod identity;
pub mod part;
pub mod write;

pub use folder::{Blocks, Folder, FolderError, MOST_BYTES};
pub use identity::Identity;
