//! A server of the files in a folder, for browsers on this machine.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::thread;
use std::time::Duration;

/// Bytes of a request that are read at the most.
const MOST_REQUEST: u64 = 8 << 10;

/// How long a browser may take over a request, or over reading the answer.
const PATIENCE: Duration = Duration::from_secs(20);

const TEXT: &str = "text/plain; charset=utf-8";

/// Types of files, by their extensions.
const TYPES: [(&str, &str); 9] = [
    ("html", "text/html; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("json", "application/json"),
    ("wasm", "application/wasm"),
    ("toml", TEXT),
    ("txt", TEXT),
    ("png", "image/png"),
    ("svg", "image/svg+xml"),
];

/// Serves files until the program ends.
pub struct Server {
    listener: TcpListener,
    address: SocketAddr,
    /// All links followed.
    folder: PathBuf,
}

impl Server {
    /// Listens on the loopback address.
    ///
    /// # Errors
    /// If the port is taken, or there is no such folder.
    pub fn new(folder: &Path, port: u16) -> io::Result<Self> {
        let folder = folder.canonicalize()?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        Ok(Self {
            address: listener.local_addr()?,
            listener,
            folder,
        })
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers requests, each on a thread of its own.
    pub fn run(&self) {
        thread::scope(|scope| {
            for stream in self.listener.incoming().flatten() {
                // A browser that goes away is no fault.
                scope.spawn(move || drop(self.answer(&stream)));
            }
        });
    }

    fn answer(&self, stream: &TcpStream) -> io::Result<()> {
        stream.set_read_timeout(Some(PATIENCE))?;
        stream.set_write_timeout(Some(PATIENCE))?;
        let request = read_request(stream)?;
        let answer = self.find(&request);
        respond(stream, answer, request.starts_with("HEAD "))
    }

    /// Returns the file of a request, or the code and the words of a refusal.
    fn find(&self, request: &str) -> Result<PathBuf, (u16, &'static str)> {
        let mut words = request.split(' ');
        let (method, target) = (words.next(), words.next().unwrap_or_default());
        if !matches!(method, Some("GET" | "HEAD")) {
            return Err((405, "Method Not Allowed"));
        }
        let path = target.split(['?', '#']).next().unwrap_or_default();
        let path = path.strip_prefix('/').ok_or((400, "Bad Request"))?;
        let path = percent_encoding::percent_decode_str(path).decode_utf8();
        let path = path.map_err(|_| (400, "Bad Request"))?;
        let relative = Path::new(&*path);
        let is_below = |part: Component<'_>| matches!(part, Component::Normal(_));
        if !relative.components().all(is_below) || path.contains(['\\', '\0', ':']) {
            return Err((404, "Not Found"));
        }
        let mut file = self.folder.join(relative);
        if file.is_dir() {
            file.push("index.html");
        }
        // A link may lead anywhere.
        let file = file.canonicalize().map_err(|_| (404, "Not Found"))?;
        if !file.starts_with(&self.folder) || !file.is_file() {
            return Err((404, "Not Found"));
        }
        Ok(file)
    }
}

/// Reads the first line of a request; the others do not matter here.
fn read_request(stream: &TcpStream) -> io::Result<String> {
    let mut reader = BufReader::new(stream.take(MOST_REQUEST));
    let (mut first, mut line) = (String::new(), String::new());
    reader.read_line(&mut first)?;
    // Read to its end: a connection that is closed with something unread loses the answer.
    while reader.read_line(&mut line)? > 2 {
        line.clear();
    }
    Ok(first)
}

fn respond(
    mut stream: &TcpStream,
    answer: Result<PathBuf, (u16, &'static str)>,
    is_head: bool,
) -> io::Result<()> {
    let (status, kind, content) = match answer {
        Ok(path) => match std::fs::read(&path) {
            Ok(content) => (String::from("200 OK"), kind_of(&path), content),
            Err(_) => (String::from("404 Not Found"), TEXT, Vec::new()),
        },
        Err((code, words)) => {
            let text = format!("{words}\n").into_bytes();
            (format!("{code} {words}"), TEXT, text)
        }
    };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-cache\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
        content.len()
    )?;
    if !is_head {
        stream.write_all(&content)?;
    }
    stream.flush()
}

/// The type of a file by its extension.
fn kind_of(path: &Path) -> &'static str {
    let extension = path.extension().unwrap_or_default();
    let known = TYPES.iter().find(|(own, _)| extension == *own);
    known.map_or("application/octet-stream", |(_, kind)| kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> tempfile::TempDir {
        let outer = tempfile::tempdir().unwrap();
        let page = outer.path().join("page");
        std::fs::create_dir_all(page.join("scenes")).unwrap();
        for (name, text) in [
            ("page/index.html", "<p>"),
            ("page/gridel.wasm", "\0asm"),
            ("page/scenes/a b.toml", "a"),
            ("secret", "s"),
        ] {
            std::fs::write(outer.path().join(name), text).unwrap();
        }
        outer
    }

    fn ask(server: &Server, request: &str) -> String {
        thread::scope(|scope| {
            scope.spawn(|| {
                let (stream, _) = server.listener.accept().unwrap();
                let _ = server.answer(&stream);
            });
            let mut stream = TcpStream::connect(server.address()).unwrap();
            stream.write_all(request.as_bytes()).unwrap();
            let mut answer = String::new();
            stream.read_to_string(&mut answer).unwrap();
            answer
        })
    }

    fn get(server: &Server, path: &str) -> String {
        ask(
            server,
            &format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"),
        )
    }

    #[test]
    fn files_come_with_their_types_and_folders_with_their_index() {
        let outer = folder();
        let server = Server::new(&outer.path().join("page"), 0).unwrap();
        assert!(server.address().ip().is_loopback());
        let index = get(&server, "/");
        assert!(index.starts_with("HTTP/1.1 200 OK\r\n"), "{index}");
        assert!(index.contains("Content-Type: text/html") && index.ends_with("\r\n\r\n<p>"));
        let wasm = get(&server, "/gridel.wasm?a=1");
        assert!(wasm.contains("Content-Type: application/wasm\r\nContent-Length: 4\r\n"));
        assert!(get(&server, "/scenes/a%20b.toml").ends_with("\r\n\r\na"));
        let head = ask(&server, "HEAD /gridel.wasm HTTP/1.1\r\n\r\n");
        assert!(head.contains("Content-Length: 4") && head.ends_with("\r\n\r\n"));
    }

    #[test]
    fn nothing_outside_of_the_folder_is_served() {
        let outer = folder();
        let page = outer.path().join("page");
        let secret = outer.path().join("secret");
        #[cfg(unix)]
        std::os::unix::fs::symlink(&secret, page.join("link")).unwrap();
        let server = Server::new(&page, 0).unwrap();
        let absolute = format!("/{}", secret.display());
        for path in [
            "/../secret",
            "/scenes/../../secret",
            "/%2e%2e/secret",
            "/..%2fsecret",
            "/..%5csecret",
            "/..\\secret",
            "/link",
            "/none",
            "/scenes",
            "//etc/passwd",
            "/%00",
            &absolute,
        ] {
            let answer = get(&server, path);
            assert!(answer.starts_with("HTTP/1.1 404 "), "{path}: {answer}");
        }
        for (request, code) in [
            ("POST / HTTP/1.1\r\n\r\n", 405),
            ("GET secret HTTP/1.1\r\n\r\n", 400),
            ("GET /%ff HTTP/1.1\r\n\r\n", 400),
            ("\r\n\r\n", 405),
        ] {
            let answer = ask(&server, request);
            assert!(
                answer.starts_with(&format!("HTTP/1.1 {code} ")),
                "{request:?}: {answer}"
            );
        }
    }

    #[test]
    fn port_that_is_taken_is_an_error() {
        let outer = folder();
        let server = Server::new(outer.path(), 0).unwrap();
        assert!(Server::new(outer.path(), server.address().port()).is_err());
        assert!(Server::new(&outer.path().join("none"), 0).is_err());
    }
}
