mod expression;
mod measure;
mod slip;
mod table;
mod what;
