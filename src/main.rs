//! The `bryant` command.

fn main() -> std::process::ExitCode {
    bryant::command::main()
}
