mod mesh;
mod route;
