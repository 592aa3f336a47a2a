//! A server of the files in a folder, for browsers on this machine.

use super::timed::Timed;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

/// Bytes of a request's lines at the most. Browsers send the cookies of all servers on this machine.
const MOST_REQUEST: usize = 64 << 10;

/// Bytes that are read at the most, so that an answer to too many of them arrives.
const MOST_READ: u64 = 1 << 20;

/// Longest time for the whole rest of a rejected request.
const REST_PATIENCE: Duration = Duration::from_secs(1);

/// Time to wait after a connection could not be accepted: there may be too many of them.
const PAUSE: Duration = Duration::from_millis(50);

/// Longest time for a browser to send a whole request, and to read the whole answer.
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

/// Connections at once; more are closed. Each takes a thread.
const MOST_CONNECTIONS: usize = 128;

/// A connection that is counted as long as it lasts.
struct Counted<'n>(&'n AtomicUsize);

impl<'n> Counted<'n> {
    fn new(number: &'n AtomicUsize) -> Self {
        number.fetch_add(1, Ordering::Relaxed);
        Self(number)
    }
}

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// The code and the words of a refusal.
type Refusal = (u16, &'static str);

const BAD_REQUEST: Refusal = (400, "Bad Request");
const NOT_FOUND: Refusal = (404, "Not Found");
/// The answer to a request under another host name: another site could read the files under it.
const MISDIRECTED: Refusal = (421, "Misdirected Request");

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

    /// Returns the address at which it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Answers requests, each on a thread of its own.
    pub fn run(&self) {
        let answering = AtomicUsize::new(0);
        thread::scope(|scope| {
            for stream in self.listener.incoming() {
                let Ok(stream) = stream else {
                    thread::sleep(PAUSE);
                    continue;
                };
                if answering.load(Ordering::Relaxed) >= MOST_CONNECTIONS {
                    continue;
                }
                let counted = Counted::new(&answering);
                // A browser that goes away is no fault. Without a thread the connection is closed.
                let answer = move || {
                    let _counted = counted;
                    drop(self.answer(&stream));
                };
                drop(thread::Builder::new().spawn_scoped(scope, answer));
            }
        });
    }

    fn answer(&self, stream: &TcpStream) -> io::Result<()> {
        let request = read_request(Timed::new(stream, PATIENCE))?;
        let is_head = request.as_ref().is_ok_and(|it| it.starts_with("HEAD "));
        let answer = request.and_then(|it| self.find(&it));
        let is_rejected = answer.is_err();
        respond(Timed::new(stream, PATIENCE), answer, is_head)?;
        if is_rejected {
            // A connection that is closed with something unread loses the answer.
            stream.shutdown(Shutdown::Write)?;
            let rest = Timed::new(stream, REST_PATIENCE);
            io::copy(&mut rest.take(MOST_READ), &mut io::sink())?;
        }
        Ok(())
    }

    /// Returns the file of a request.
    fn find(&self, request: &str) -> Result<PathBuf, Refusal> {
        let mut words = request.split(' ');
        let (method, target) = (words.next(), words.next().unwrap_or_default());
        if !matches!(method, Some("GET" | "HEAD")) {
            return Err((405, "Method Not Allowed"));
        }
        let path = path_of(target).split(['?', '#']).next().unwrap_or_default();
        let path = path.strip_prefix('/').ok_or(BAD_REQUEST)?;
        let path = percent_encoding::percent_decode_str(path).decode_utf8();
        let path = path.map_err(|_| BAD_REQUEST)?;
        let relative = Path::new(&*path);
        let is_below = |part: Component<'_>| matches!(part, Component::Normal(_));
        if !relative.components().all(is_below) || path.contains(['\\', '\0', ':']) {
            return Err(NOT_FOUND);
        }
        let mut file = self.folder.join(relative);
        if file.is_dir() {
            file.push("index.html");
        }
        // A link may lead anywhere.
        let file = file.canonicalize().map_err(|_| NOT_FOUND)?;
        if !file.starts_with(&self.folder) || !file.is_file() {
            return Err(NOT_FOUND);
        }
        Ok(file)
    }
}

/// The path of a target, which may name its server, too: `http://host/path`.
fn path_of(target: &str) -> &str {
    match target.split_once("://") {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("http") => {
            rest.find('/').map_or("/", |start| &rest[start..])
        }
        _ => target,
    }
}

/// Reads the first line of a request, and checks that it names this machine as its host.
fn read_request(stream: impl Read) -> io::Result<Result<String, Refusal>> {
    let mut reader = BufReader::new(stream.take(MOST_READ));
    let (mut first, mut line) = (Vec::new(), Vec::new());
    let mut length = reader.read_until(b'\n', &mut first)?;
    let mut is_for_this_machine = true;
    loop {
        line.clear();
        let read = reader.read_until(b'\n', &mut line)?;
        length += read;
        if read <= 2 {
            break;
        }
        is_for_this_machine &= host_of(&line).is_none_or(is_loopback);
    }
    Ok(match String::from_utf8(first) {
        _ if length > MOST_REQUEST => Err((431, "Request Header Fields Too Large")),
        _ if !is_for_this_machine => Err(MISDIRECTED),
        Ok(first) => Ok(first),
        Err(_) => Err(BAD_REQUEST),
    })
}

/// The value of a header's line, if it is `Host`.
fn host_of(line: &[u8]) -> Option<&[u8]> {
    let colon = line.iter().position(|&byte| byte == b':')?;
    let (name, value) = (&line[..colon], &line[colon + 1..]);
    name.eq_ignore_ascii_case(b"host")
        .then(|| value.trim_ascii())
}

/// Returns true for a name of this machine, with a port or without.
fn is_loopback(host: &[u8]) -> bool {
    let host = host.to_ascii_lowercase();
    ["localhost", "127.0.0.1", "[::1]"].iter().any(|name| {
        let port = host.strip_prefix(name.as_bytes());
        port.is_some_and(|it| {
            it.is_empty() || it[0] == b':' && it[1..].iter().all(u8::is_ascii_digit)
        })
    })
}

fn respond(
    mut stream: impl Write,
    answer: Result<PathBuf, Refusal>,
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

    fn ask(server: &Server, request: impl AsRef<[u8]>) -> String {
        thread::scope(|scope| {
            scope.spawn(|| {
                let (stream, _) = server.listener.accept().unwrap();
                let _ = server.answer(&stream);
            });
            let mut stream = TcpStream::connect(server.address()).unwrap();
            stream.write_all(request.as_ref()).unwrap();
            let mut answer = String::new();
            stream.read_to_string(&mut answer).unwrap();
            answer
        })
    }

    fn get(server: &Server, path: &str) -> String {
        ask(
            server,
            format!("GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n"),
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
    fn only_names_of_this_machine_are_served() {
        let outer = folder();
        let server = Server::new(&outer.path().join("page"), 0).unwrap();
        for (host, code) in [
            ("localhost", 200),
            ("LOCALHOST:8000", 200),
            ("127.0.0.1:8000", 200),
            ("[::1]:8000", 200),
            ("example.org", 421),
            ("localhost.example.org", 421),
            ("127.0.0.1.example.org:8000", 421),
            ("localhost:80:80", 421),
            ("", 421),
            ("localhost\r\nHost: example.org", 421),
        ] {
            let answer = ask(&server, format!("GET / HTTP/1.1\r\nhost: {host}\r\n\r\n"));
            let expected = format!("HTTP/1.1 {code} ");
            assert!(answer.starts_with(&expected), "{host}: {answer}");
        }
    }

    #[test]
    fn requests_that_come_byte_by_byte_end() {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
        let mut slow = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        let (stream, _) = listener.accept().unwrap();
        slow.write_all(b"GET").unwrap();
        let timed = Timed::new(&stream, Duration::ZERO);
        let error = read_request(timed).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::TimedOut);
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
    fn long_headers_are_read_and_longer_ones_are_rejected_with_words() {
        let outer = folder();
        let server = Server::new(&outer.path().join("page"), 0).unwrap();
        for (bytes, code) in [
            (60_000, 200),
            (70_000, 431),
            (500_000, 431),
            (1_500_000, 431),
        ] {
            let cookie = "a".repeat(bytes);
            let request = format!("GET / HTTP/1.1\r\nCookie: {cookie}\r\n\r\n");
            let answer = ask(&server, request);
            let status = format!("HTTP/1.1 {code} ");
            assert!(answer.starts_with(&status), "{bytes}: {answer}");
            assert!(code == 200 || answer.ends_with("\r\n\r\nRequest Header Fields Too Large\n"));
        }
        let body = "x".repeat(200_000);
        let post = format!("POST / HTTP/1.1\r\nContent-Length: 200000\r\n\r\n{body}");
        assert!(ask(&server, post).starts_with("HTTP/1.1 405 "));
    }

    #[test]
    fn headers_of_other_bytes_and_targets_with_their_server_are_served() {
        let outer = folder();
        let server = Server::new(&outer.path().join("page"), 0).unwrap();
        let index = "\r\n\r\n<p>";
        assert!(ask(&server, b"GET / HTTP/1.1\r\nX: \xff\xfe\r\n\r\n").ends_with(index));
        for target in [
            "http://localhost/index.html",
            "HTTP://127.0.0.1:8000/?a",
            "http://h",
        ] {
            assert!(get(&server, target).ends_with(index), "{target}");
        }
        for (request, code) in [
            (&b"GET /\xff HTTP/1.1\r\n\r\n"[..], 400),
            (b"GET http://h/../secret HTTP/1.1\r\n\r\n", 404),
            (b"GET ftp://h/index.html HTTP/1.1\r\n\r\n", 400),
        ] {
            let answer = ask(&server, request);
            assert!(answer.starts_with(&format!("HTTP/1.1 {code} ")), "{answer}");
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
