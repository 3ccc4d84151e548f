mod choice;
mod limits;
mod places;
