//! Readers of files against damaged files: no panic, no hang, bounded memory.
//!
//! Execution k is a function of seed k alone: it takes a sound file, mutates it (`mutate`), and
//! reads it. `make verify-fuzz PART=study|surface|pulse|journal|market|calculix|dense|rail|run|dynamic` runs 10 million of
//! one reader and goes on anywhere with `OPSHOCK_SEEDS=first..end`; `make test` runs some thousands of each.

mod corpus;
mod imports;
mod journal;
mod mutate;
mod text;
mod watch;
