mod curve;
mod digest;
mod resolve;
mod rule;
mod thinning;
mod units;
mod unloading;
