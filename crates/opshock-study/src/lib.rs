#![doc = include_str!("../README.md")]

pub mod accuracy;
pub mod batch;
pub mod draws;
pub mod hard_cases;
pub mod identity;
pub mod matching;
pub mod population;
pub mod provenance;
pub mod qualification;
pub mod record;
pub mod report;
pub mod search;
pub mod store;
pub mod study;
pub mod sweep;
pub mod worth;
