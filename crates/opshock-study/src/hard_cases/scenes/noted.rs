//! Notes the structures that a case runs, so that a caller can run all of them in another way.

use super::structures::Structure;
use std::cell::RefCell;

thread_local! {
    static NOTED: RefCell<Option<Vec<(Structure, f64)>>> = const { RefCell::new(None) };
}

/// Structures and amplitudes, m/s², that `f` runs on this thread, in order.
pub fn structures_of(f: impl FnOnce()) -> Vec<(Structure, f64)> {
    NOTED.set(Some(Vec::new()));
    f();
    NOTED.take().unwrap_or_default()
}

/// Notes a structure about to be run, if a caller listens.
pub(in crate::hard_cases) fn note(structure: &Structure, amplitude_m_per_s2: f64) {
    NOTED.with_borrow_mut(|noted| {
        if let Some(noted) = noted {
            noted.push((structure.clone(), amplitude_m_per_s2));
        }
    });
}
