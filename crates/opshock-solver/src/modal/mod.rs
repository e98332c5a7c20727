//! Advances modal oscillators exactly: free flow, closed-form response to forcing, energies and losses.

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
