//! Gives the state of air at a temperature and an altitude: pressure, viscosity, mean free path.

/// State of the gas around the drive.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct GasParameters {
    /// Ambient pressure, Pa.
    pub pressure_pa: f64,
    /// Dynamic viscosity, Pa s.
    pub viscosity_pa_s: f64,
    /// Mean free path at the ambient pressure, m.
    pub mean_free_path_m: f64,
}

/// Pressure of the standard atmosphere at sea level, Pa.
pub const SEA_LEVEL_PRESSURE_PA: f64 = 101_325.0;

/// Viscosity of air at [`REFERENCE_TEMPERATURE_K`], Pa s (value in use for head-disk interfaces).
pub const REFERENCE_VISCOSITY_PA_S: f64 = 1.806e-5;

/// Mean free path of air at sea-level pressure and [`REFERENCE_TEMPERATURE_K`], m.
pub const REFERENCE_MEAN_FREE_PATH_M: f64 = 63.5e-9;

/// Temperature at which Sutherland's law gives [`REFERENCE_VISCOSITY_PA_S`], K (18.45 degrees C).
pub const REFERENCE_TEMPERATURE_K: f64 = 291.604_330_153_864_4;

/// Pressure of the standard atmosphere at a geopotential altitude, Pa.
///
/// ```text
/// p = p0 (1 - L h / T0)^(g M / (R L)),   L = 6.5 K/km,  T0 = 288.15 K
/// ```
///
/// Holds in the troposphere, from -5 to 11 km.
///
/// # Source
/// U.S. Standard Atmosphere 1976, equation 33a and table 4.
pub fn standard_pressure_pa(altitude_m: f64) -> f64 {
    const LAPSE_K_PER_M: f64 = 6.5e-3;
    const SEA_LEVEL_K: f64 = 288.15;
    const EXPONENT: f64 = 9.80665 * 0.028_964_4 / (8.314_32 * LAPSE_K_PER_M);
    SEA_LEVEL_PRESSURE_PA * (1.0 - LAPSE_K_PER_M * altitude_m / SEA_LEVEL_K).powf(EXPONENT)
}

/// Viscosity of air at a temperature, Pa s; independent of pressure.
///
/// ```text
/// mu = beta T^(3/2) / (T + S),   beta = 1.458e-6 kg/(s m K^(1/2)),  S = 110.4 K
/// ```
///
/// # Source
/// Sutherland's law as in U.S. Standard Atmosphere 1976, equation 51.
pub fn viscosity_pa_s(temperature_k: f64) -> f64 {
    1.458e-6 * temperature_k.powf(1.5) / (temperature_k + 110.4)
}

/// Mean free path, m, of air of a viscosity at a pressure and a temperature.
///
/// Kinetic theory gives lambda proportional to mu sqrt(T) / p; the factor is taken from the
/// reference state, so that the reference state returns [`REFERENCE_MEAN_FREE_PATH_M`].
///
/// # Source
/// Chapman and Cowling (1970), section 12.1: mu = 0.499 rho c lambda, c = sqrt(8 R T / pi).
pub fn mean_free_path_m(viscosity_pa_s: f64, pressure_pa: f64, temperature_k: f64) -> f64 {
    REFERENCE_MEAN_FREE_PATH_M
        * (viscosity_pa_s / REFERENCE_VISCOSITY_PA_S)
        * (SEA_LEVEL_PRESSURE_PA / pressure_pa)
        * (temperature_k / REFERENCE_TEMPERATURE_K).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pressure_follows_the_standard_atmosphere() {
        // U.S. Standard Atmosphere 1976, table I, geopotential altitude.
        for (altitude_m, pressure_pa) in [(0.0, 101_325.0), (1000.0, 89_874.6), (3000.0, 70_108.5)]
        {
            let computed = standard_pressure_pa(altitude_m);
            assert!(
                (computed / pressure_pa - 1.0).abs() < 2e-6,
                "{altitude_m} m: {computed}"
            );
        }
    }

    #[test]
    fn viscosity_follows_the_standard_atmosphere() {
        // U.S. Standard Atmosphere 1976, table II: 1.7894e-5 at 288.15 K, 1.4216e-5 at 216.65 K.
        assert!((viscosity_pa_s(288.15) - 1.7894e-5).abs() < 1e-9);
        assert!((viscosity_pa_s(216.65) - 1.4216e-5).abs() < 1e-9);
    }

    #[test]
    fn the_reference_state_is_one_state() {
        let mu = viscosity_pa_s(REFERENCE_TEMPERATURE_K);
        assert!(
            (mu / REFERENCE_VISCOSITY_PA_S - 1.0).abs() < 1e-12,
            "{mu:e}"
        );
        let lambda = mean_free_path_m(mu, SEA_LEVEL_PRESSURE_PA, REFERENCE_TEMPERATURE_K);
        assert!((lambda / REFERENCE_MEAN_FREE_PATH_M - 1.0).abs() < 1e-12);
        // Half the pressure, twice the path.
        let half = mean_free_path_m(mu, SEA_LEVEL_PRESSURE_PA / 2.0, REFERENCE_TEMPERATURE_K);
        assert!((half / lambda - 2.0).abs() < 1e-12);
    }
}
