mod breakpoints;
mod form;
mod order;
