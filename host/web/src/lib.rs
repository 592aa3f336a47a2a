//! Gridel for web pages: the compiler and the core in WebAssembly, behind one function.
//!
//! A page writes a request to the memory that [`input`] returns, calls [`call`], and reads the answer at
//! [`output_address`]. Requests and answers have the same form. They begin with the length of a JSON text in 4 bytes,
//! little-endian. The text follows, and bytes that belong to it, such as a file or pixels. `page/worker.js` does this.
//! An answer whose JSON has the key `error` is an error.
//!
//! | file | what is in it |
//! |---|---|
//! | `request.rs` | the requests |
//! | `session.rs` | what a worker holds, and the answers |
//! | `loaded.rs` | a blob and its scene |
//! | `drawing.rs` | a picture that is being drawn |
//! | `pictures.rs` | errors between pictures, maps, files |
//! | `problem.rs` | errors, as the program prints them |

mod drawing;
mod loaded;
mod pictures;
mod problem;
mod request;
mod session;

use problem::Problem;
use serde_json::Value;
use session::Session;
use std::cell::RefCell;

/// An answer: JSON, and bytes that belong to it.
type Answer = Result<(Value, Vec<u8>), Problem>;

#[derive(Default)]
struct State {
    session: Session,
    input: Vec<u8>,
    output: Vec<u8>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

/// Makes room for a request of `length` bytes, and returns its address.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn input(length: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.output = Vec::new();
        state.input = vec![0; length];
        state.input.as_mut_ptr()
    })
}

/// Answers the request, and returns the length of the answer.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn call() -> usize {
    STATE.with_borrow_mut(|state| {
        let input = std::mem::take(&mut state.input);
        let answer = request::split(&input)
            .and_then(|(request, bytes)| state.session.answer(request, bytes));
        let (json, bytes) = answer.unwrap_or_else(|problem| (problem.json(), Vec::new()));
        let json = json.to_string();
        let length = json.len() as u32;
        state.output = [&length.to_le_bytes(), json.as_bytes(), &bytes].concat();
        state.output.len()
    })
}

/// Returns the address of the answer.
// SAFETY: no other function of the module has this name.
#[unsafe(no_mangle)]
pub extern "C" fn output_address() -> *const u8 {
    STATE.with_borrow(|state| state.output.as_ptr())
}
