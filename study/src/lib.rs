//! Studies: many runs of one model. The crate decides which runs there are, keeps their results, and summarises them.
//!
//! ```text
//! study file ─file→ Study ─design→ rows ─engine→ outcomes ─store→ blocks in a folder ─table→ Parquet, CSV
//!                                                                                  └─summary→ numbers, pictures
//! ```
//!
//! This crate knows no model and no compiler: [`engine::Engine`] hides them. A row's parameters depend only on the
//! study and the row's index, and a block's results only on the study and the block's index. So any number of threads
//! and processes can fill one folder in any order and may be ended at any time, and the table always has the same
//! bytes.
//!
//! | module | what it holds |
//! |---|---|
//! | [`mod@file`] | the YAML file, checked against [`facts`] of a model |
//! | [`study`], [`response`] | a checked study; the numbers that are read off each run |
//! | [`criteria`] | injury criteria, and their limits by regulations |
//! | [`design`], [`distribution`], [`normal`], [`hash`], [`digest`] | the values of a row |
//! | [`engine`] | the traits of an engine that runs rows |
//! | [`run`], [`shard`], [`series`] | runs the missing rows |
//! | [`store`] | the folder of results |
//! | [`results`], [`table`] | all results; their tables |
//! | [`summary`], [`picture`], [`report`] | summaries of the results |
//! | [`quantity`] | numbers with units |
#![warn(clippy::disallowed_methods)]

pub mod criteria;
pub mod design;
pub mod digest;
pub mod distribution;
pub mod engine;
pub mod facts;
pub mod file;
pub mod hash;
pub mod normal;
pub mod picture;
pub mod quantity;
pub mod report;
pub mod response;
pub mod results;
pub mod run;
pub mod series;
pub mod shard;
pub mod store;
pub mod study;
pub mod summary;
pub mod table;
