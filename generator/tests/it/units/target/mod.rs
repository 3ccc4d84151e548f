mod aarch64;
mod c;
mod machine;
mod rust;
mod x86_64;
