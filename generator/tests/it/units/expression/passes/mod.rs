mod factor;
mod flatten;
mod fuse;
mod pairs;
mod rebuild;
mod recall;
mod replace;
