//! What the tests share: reference data, named scenes, the built program.

pub mod bodies;
pub mod hdf5_dump;
pub mod heads;
pub mod mock_sweep;
pub mod scenes;
pub mod structures;
pub mod suspensions;
