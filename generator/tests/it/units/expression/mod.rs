mod count;
mod differentiate;
mod evaluate;
mod graph;
mod live;
mod passes;
mod print;
mod properties;
