//! The `bryant` command.
#![warn(clippy::disallowed_methods)]

fn main() -> std::process::ExitCode {
    bryant::command::main()
}
