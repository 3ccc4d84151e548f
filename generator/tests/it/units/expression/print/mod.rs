mod latex;
mod text;
