mod names;
mod support;
