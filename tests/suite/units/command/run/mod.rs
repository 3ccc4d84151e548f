mod outcome;
mod responses;
mod scene;
