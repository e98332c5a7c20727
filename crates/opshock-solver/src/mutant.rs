//! Deletes one condition of a rule, for the tests that must notice it.
//!
//! With the feature `mutants`, which only `make verify-effects` enables, `with` runs a closure in which `is_on` is true
//! for one name. Without it `is_on` is the constant `false` and compiles to nothing. A name consists of a rule and the
//! condition it loses. Names are queried while a model is built or a run begins, never within the arithmetic.

#[cfg(feature = "mutants")]
mod switch {
    use std::cell::Cell;

    thread_local! {
        static ON: Cell<&'static str> = const { Cell::new("") };
    }

    /// Runs `f` on this thread with the condition `name` deleted; a panic of `f` ends it too.
    pub fn with<T>(name: &'static str, f: impl FnOnce() -> T) -> T {
        struct Off;
        impl Drop for Off {
            fn drop(&mut self) {
                ON.set("");
            }
        }
        let _off = Off;
        ON.set(name);
        f()
    }

    pub(crate) fn is_on(name: &str) -> bool {
        ON.get() == name
    }
}

#[cfg(feature = "mutants")]
pub(crate) use switch::is_on;
#[cfg(feature = "mutants")]
pub use switch::with;

/// Whether the condition `name` is deleted: never.
#[cfg(not(feature = "mutants"))]
pub(crate) const fn is_on(_name: &str) -> bool {
    false
}
