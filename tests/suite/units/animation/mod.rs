mod plate;
mod shape;
mod turn;
