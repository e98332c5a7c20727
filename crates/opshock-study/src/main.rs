//! The `opshock` program.

fn main() -> std::process::ExitCode {
    opshock_study::cli::main()
}
