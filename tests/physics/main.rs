//! Physics against references, invariants and relations.

mod base;
mod base_chain;
mod base_pivot;
mod bodies;
mod contact;
mod contact_energy;
mod contact_method;
mod contact_stiffness;
mod coupled_ramp;
mod effects;
mod effects_hard_cases;
#[cfg(feature = "mutants")]
mod effects_mutants;
mod film_defect;
mod film_flight;
mod film_flow_factor;
mod film_plane;
mod film_squeeze;
mod film_squeezed_slider;
mod film_steps;
mod film_waves;
mod free_motion;
mod head_coupling;
mod head_rest;
mod head_shock;
mod head_touch;
mod hub;
mod limiters;
mod mirror;
mod oblique;
mod plate;
mod pressure_fields;
mod responses;
mod run_out;
mod surface_forces;
mod suspension;
