//! After settling, a simulation allocates nothing in its steps.
//!
//! The counting allocator, which needs `unsafe`, is why this is a binary of its own.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

use opshock_solver::simulation::{Model, Request, Scope, Workspace, simulate};
use opshock_tests::scenes;

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: every call is passed on to the system's allocator unchanged; counting touches no memory
// but its own atomic.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Allocations of one run over a window of this length.
fn allocations(window_s: f64) -> (u64, u64) {
    let scene = scenes::paper_deformable(0.5e-3, window_s, 600);
    let model = Model::build(&scene, Scope::Full, None).expect("the scene builds");
    let mut workspace = Workspace::default();
    let request = Request {
        amplitude_m_per_s2: 190.0 * 9.80665,
        record: false,
    };
    simulate(&model, &request, &mut workspace);
    let before = ALLOCATIONS.load(Ordering::Relaxed);
    let outcome = simulate(&model, &request, &mut workspace);
    let count = ALLOCATIONS.load(Ordering::Relaxed) - before;
    (count, outcome.cost.steps + outcome.cost.structure_steps)
}

#[test]
fn steps_allocate_nothing() {
    let (short, few) = allocations(0.5e-3);
    let (long, many) = allocations(2.0e-3);
    assert!(many > few + 2000, "{few} and {many} steps");
    // A run allocates its results: the history of the disk and growing lists of contacts. Steps
    // themselves allocate nothing, so thousands more of them cost a few reallocations at most.
    assert!(
        long <= short + 60,
        "{short} allocations in {few} steps, {long} in {many}"
    );
}
