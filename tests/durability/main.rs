//! What a store keeps when everything around it fails.

mod flipped;
mod full_disk;
mod kills;
mod limits;
mod power_loss;
mod signals;
mod sim_files;
