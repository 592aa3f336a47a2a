//! The program `gridel`: compiles scenes, tells what is in a blob, renders and traces.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
