mod expression;
mod file_content;
mod measure;
mod slip;
mod table;
