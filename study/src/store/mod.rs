//! The store of results: a folder that any number of processes may fill, and that never has partial results.
//!
//! ```text
//! study.json            what the results are of
//! blocks/00000017.part  results of a block of rows: whole or not there
//! series/run-….csv      time series of runs that are kept
//! study/                what whoever runs the study keeps with it
//! results.parquet, …    the table, when all blocks are there
//! ```

pub mod folder;
pub mod identity;
pub mod part;
pub mod write;

pub use folder::{Blocks, Folder, FolderError, MOST_BYTES};
pub use identity::Identity;
