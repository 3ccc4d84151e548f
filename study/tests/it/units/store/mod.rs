mod identity;
mod part;
