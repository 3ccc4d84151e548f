mod comment;
mod expression;
mod results;
