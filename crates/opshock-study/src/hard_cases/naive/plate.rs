//! Naive methods for disks: loads by quadrature, powers of the radius, static solves at speed.

/// Harmonics 1 to `n` that a uniform load drives when it is summed over 360 sectors.
pub fn harmonics_of_a_uniform_load(n: usize) -> usize {
    let sector = std::f64::consts::TAU / 360.0;
    let load = |n: usize| -> f64 {
        let angles = (0..360).map(|j| (n * j) as f64 * sector);
        angles.map(|angle| angle.cos() * sector).sum()
    };
    (1..=n).filter(|&n| load(n) != 0.0).count()
}

/// Whether the mass matrix of the powers 1, r, … r^(n − 1) on a disk from `inner` to 1 is positive
/// definite in double precision.
pub fn powers_of_the_radius_are_definite(inner: f64, n: usize) -> bool {
    // ∫ r^(i+j) r dr
    let entry = |i: usize, j: usize| {
        let power = (i + j + 2) as i32;
        (1.0 - inner.powi(power)) / f64::from(power)
    };
    nalgebra::DMatrix::from_fn(n, n, entry).cholesky().is_some()
}

/// Static deflection under a load fixed in space, of the deflection at rest, by the stiffness
/// ω² − (n Ω)² of the frame fixed in space; `ratio` is n Ω/ω.
pub fn static_amplification(ratio: f64) -> f64 {
    1.0 / (1.0 - ratio * ratio).abs()
}
