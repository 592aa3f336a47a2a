//! `gridel web`: serves the web page to this machine.

mod server;
mod timed;

use super::failure::Failure;
use super::output::print;
use clap::Args;
use server::Server;
use std::path::PathBuf;

/// Serve the web page to this machine
///
/// The page compiles and renders scenes in the browser: `just web` builds it, and `gridel help web` describes it. Any
/// file server can serve its folder; this one listens on the loopback address alone, and serves files of that folder
/// alone, until it is interrupted.
#[derive(Args)]
#[command(after_help = super::failure::EXIT_CODES)]
pub struct Arguments {
    /// Folder of the page, which `just web` builds
    #[arg(long, value_name = "FOLDER")]
    dir: PathBuf,

    /// Port to listen on; 0 for one that is free
    #[arg(long, value_name = "N", default_value_t = 8000)]
    port: u16,
}

/// Serves the page.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { dir, port } = arguments;
    if !dir.join("index.html").is_file() {
        return Err(Failure::usage(
            format!("{} has no file index.html", dir.display()),
            "build the page with `just web`, and name the folder that it prints",
        ));
    }
    let server = Server::new(dir, *port).map_err(|error| {
        Failure::failed(
            format!("{} cannot be served on port {port}: {error}", dir.display()),
            "choose another port with `--port`; 0 takes a free one",
        )
    })?;
    print(format!(
        "http://{}/ shows {} on this machine; interrupt to stop\n",
        server.address(),
        dir.display()
    ))?;
    server.run();
    Ok(())
}
