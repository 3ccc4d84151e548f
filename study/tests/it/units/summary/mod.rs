mod chaos;
mod errors;
mod family;
mod moments;
mod sample;
mod text;
