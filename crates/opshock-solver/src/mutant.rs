//! Rules with one condition deleted, for the tests that must notice it.
//!
//! With the feature `mutants`, which only `make verify-effects` asks for, `with` runs a closure in which
//! `is_on` is true of one name. Without it `is_on` is the constant `false` and leaves nothing
//! behind. Names are a rule and the condition it loses; they are asked for while a model is built
//! or a run begins, never in the middle of the arithmetic.

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
