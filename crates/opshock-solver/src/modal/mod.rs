//! Modal subsystems: exact propagation, forcing in closed form, energy.

pub mod bank;
pub mod coupled;
pub mod forcing;
pub mod oscillator;
pub mod part_flow;

pub use bank::{BankFlow, ModalState, Readout};
pub use coupled::{
    Coordinates, CoupledFlow, CoupledModes, CoupledState, CoupledSystem, Maxwell, PointReadout,
};
pub use forcing::{FirstOrderResponse, ForcedResponse, Phase};
pub use oscillator::{Flow, LossForm, Oscillator};
pub use part_flow::PartFlows;
