//! Long work that Python's Ctrl-C interrupts.

use crate::failure::raised_fault;
use opshock::cli::failure::Fault;
use opshock_study::sweep::StopFlag;
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::time::Duration;

/// Time between two looks at Python's signals.
const BETWEEN_LOOKS: Duration = Duration::from_millis(50);

/// Does `work` on a thread of its own, without Python's lock. A signal whose handler raises asks `stop`; what it raised is
/// raised again once the work has ended.
pub fn interruptible<T: Send>(
    py: Python<'_>,
    stop: &StopFlag,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let (answer, raised) = py.detach(|| {
        std::thread::scope(|scope| {
            // Closed when the work ends, in whatever way.
            let (ended, end) = sync_channel::<()>(0);
            let working = scope.spawn(move || {
                let _ended = ended;
                work()
            });
            let mut raised = None;
            while end.recv_timeout(BETWEEN_LOOKS) == Err(RecvTimeoutError::Timeout) {
                if let Err(error) = Python::attach(|py| py.check_signals()) {
                    stop.ask();
                    raised.get_or_insert(error);
                }
            }
            (working.join(), raised)
        })
    });
    match (answer, raised) {
        (_, Some(error)) => Err(error),
        (Ok(answer), None) => Ok(answer),
        (Err(panic), None) => {
            let words = panic.downcast_ref::<String>().map(String::as_str);
            let words = words.or(panic.downcast_ref::<&str>().copied());
            let words = words.unwrap_or("no message").to_owned();
            let fault = Fault::new("panicked", format!("a simulation panicked: {words}"));
            Err(raised_fault(py, fault))
        }
    }
}
