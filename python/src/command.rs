//! Commands of the program, in this process.

use bryant::command::{Captured, captured};
use bryant::interrupt;
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Time after which Python is asked again whether Ctrl-C was pressed.
const PATIENCE: Duration = Duration::from_millis(50);

/// One command runs at a time: Ctrl-C ends all that run.
static ONE: Mutex<()> = Mutex::new(());

/// Runs a command line, without the name of the program. Returns its exit code, what it printed, and its messages.
/// Ctrl-C ends it, and is raised.
#[pyfunction]
pub fn command(py: Python<'_>, line: Vec<String>) -> PyResult<(u8, String, String)> {
    let (send, receive) = sync_channel::<Captured>(1);
    let thread = std::thread::Builder::new().stack_size(64 << 20);
    let work = move || {
        let _alone = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        interrupt::stop(false);
        // nobody waits for a result after Ctrl-C
        let _ = send.send(captured(&line));
    };
    let running = thread.spawn(work).map_err(super::wrong)?;
    let receive = Mutex::new(receive);
    let wait = || {
        let receive = receive.lock().unwrap_or_else(PoisonError::into_inner);
        receive.recv_timeout(PATIENCE)
    };
    loop {
        match py.detach(wait) {
            Ok(done) => return Ok((done.code, done.output, done.messages)),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(interrupted) = py.check_signals() {
                    interrupt::stop(true);
                    let _ = py.detach(|| running.join());
                    return Err(interrupted);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                return Err(super::wrong(
                    "a defect of bryant ended the command; please report it",
                ));
            }
        }
    }
}
