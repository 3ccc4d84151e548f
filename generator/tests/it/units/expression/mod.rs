mod count;
mod differentiate;
mod evaluate;
mod graph;
mod liveness;
mod passes;
mod print;
mod properties;
