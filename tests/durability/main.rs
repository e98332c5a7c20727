//! What a store keeps when everything around it fails.

mod acknowledged;
mod faults;
mod flipped;
mod full_disk;
mod histories;
mod kills;
mod limits;
mod made;
mod mounted;
mod power_loss;
mod signals;
mod sim_files;
