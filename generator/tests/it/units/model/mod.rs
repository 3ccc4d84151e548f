mod curve;
mod digest;
mod resolve;
mod rule;
mod thin;
mod units;
mod unloading;
