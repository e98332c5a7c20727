//! The `opshock` program, built by the package that tests it: no test can run a stale one.

fn main() -> std::process::ExitCode {
    let code = opshock::cli::main();
    // What the system says of this process, for tests of the memory it took.
    if let Some(path) = std::env::var_os("OPSHOCK_STATUS_FILE") {
        let status = std::fs::read_to_string("/proc/self/status").expect("of Linux");
        std::fs::write(path, status).expect("the status is written");
    }
    code
}
