mod inertia;
mod reader;
