mod slopes;
mod table;
