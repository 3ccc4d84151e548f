//! The `bryant` command.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

fn main() -> std::process::ExitCode {
    bryant::command::main()
}
