mod body;
mod dummy;
mod size;
