mod cache;
mod message;
mod rustc;
