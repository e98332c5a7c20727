//! Vector instructions of the processor at hand, without asking for them when compiling.
//!
//! A kernel is a struct whose `call` is marked `#[inline(always)]`; [`widest`] compiles it once for
//! every instruction set and picks the widest that the processor has. Loops that the compiler does
//! not turn into vector code by itself say so with [`WithSimd`]. Multiplications and additions
//! are never fused, and every element of a loop is computed alone, so all sets give the same bits.

pub use pulp::{NullaryFnOnce as Kernel, Simd, WithSimd};

/// Runs `kernel` compiled for the widest vector registers of this processor.
#[inline]
pub fn widest<K: WithSimd>(kernel: K) -> K::Output {
    pulp::Arch::new().dispatch(kernel)
}
