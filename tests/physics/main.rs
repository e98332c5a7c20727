//! Physics against references, invariants and relations.

mod bodies;
mod contact;
mod contact_method;
mod contact_stiffness;
mod coupled_ramp;
mod effects;
mod effects_hard_cases;
mod effects_mutants;
mod film_flight;
mod film_flow_factor;
mod film_plane;
mod film_squeeze;
mod film_steps;
mod free_motion;
mod head_coupling;
mod head_rest;
mod head_shock;
mod head_touch;
mod hub;
mod limiters;
mod oblique;
mod plate;
mod pressure_fields;
mod run_out;
mod surface_forces;
mod suspension;
