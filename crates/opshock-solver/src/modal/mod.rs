//! Modal subsystems: exact propagation, forcing in closed form, energy.

pub mod bank;
pub mod forcing;
pub mod oscillator;

pub use bank::{BankFlow, ModalState, Readout};
pub use forcing::{ForcedResponse, Phase};
pub use oscillator::{Flow, LossForm, Oscillator};
