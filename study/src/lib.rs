//! Studies: many runs of one model. Which runs, where their results are kept, and what they say.
//!
//! ```text
//! study file ─file→ Study ─design→ rows ─engine→ outcomes ─store→ blocks in a folder ─table→ Parquet, CSV
//!                                                                                  └─summary→ numbers, indices, pictures
//! ```
//!
//! This crate knows no model and no compiler: what runs is behind [`engine::Engine`]. A row's parameters are a function of the
//! study and its index, a block's results of the study and the block's, so that any number of threads and processes fill one
//! folder in any order, may be ended at any time, and the table has the same bytes.
//!
//! | module | what it holds |
//! |---|---|
//! | [`mod@file`] | the YAML, checked against [`facts`] of a model |
//! | [`study`], [`response`] | a study as checked; what is read off each run |
//! | [`criteria`] | injury criteria, and their limits by regulations |
//! | [`design`], [`distribution`], [`normal`], [`hash`], [`digest`] | which values a row has |
//! | [`engine`] | what runs |
//! | [`run`], [`shard`], [`series`] | running what is missing |
//! | [`store`] | the folder of results |
//! | [`results`], [`table`] | all results; tables of them |
//! | [`summary`], [`picture`], [`report`] | what they say |
//! | [`quantity`] | numbers with units |

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
