//! What the tests share: reference data, named scenes, the built program.

pub mod suspensions;
