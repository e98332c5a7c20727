//! Air at a temperature and an altitude: pressure, viscosity, mean free path.

/// State of the gas around the drive.
#[derive(Clone, Debug, PartialEq)]
pub struct GasParameters {
    /// Ambient pressure, Pa.
    pub pressure_pa: f64,
    /// Dynamic viscosity, Pa s.
    pub viscosity_pa_s: f64,
    /// Mean free path at the ambient pressure, m.
    pub mean_free_path_m: f64,
}
