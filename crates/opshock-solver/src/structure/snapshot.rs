//! Keeps the state of all modes at chosen nodes of a run.

use super::rotor::RotorState;

/// State of all modes at a node.
#[derive(Clone, Debug, Default)]
pub(super) struct Snapshot {
    pub node: usize,
    /// Displacements of the bank's modes, real and imaginary parts; empty before contact drives them.
    pub modes: [Vec<f64>; 2],
    pub rotor: RotorState,
    /// Factor of the unit response that is to be added: 0 where the state is the whole motion.
    pub unit: f64,
}

/// Snapshots of a run at the nodes asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Snapshots {
    /// Nodes asked for, rising.
    pub nodes: Vec<usize>,
    /// Those reached, in that order.
    pub taken: Vec<Snapshot>,
}

impl Snapshots {
    /// Keeps this state of `node` if it is the next asked for.
    pub fn offer(&mut self, node: usize, modes: [&[f64]; 2], rotor: &RotorState, unit: f64) {
        if self.nodes.get(self.taken.len()) == Some(&node) {
            self.taken.push(Snapshot {
                node,
                modes: modes.map(<[f64]>::to_vec),
                rotor: rotor.clone(),
                unit,
            });
        }
    }
}
