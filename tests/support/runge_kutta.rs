//! The classical Runge-Kutta rule, as far from the program's closed forms as a rule can be.

use std::ops::{Add, Mul};

/// `y` after one step `dt` of y' = rate(t, y): fourth order.
pub fn step<T>(t: f64, dt: f64, y: &[T], rate: impl Fn(f64, &[T]) -> Vec<T>) -> Vec<T>
where
    T: Copy + Add<Output = T> + Mul<f64, Output = T>,
{
    let add = |y: &[T], k: &[T], f: f64| -> Vec<T> {
        y.iter().zip(k).map(|(y, k)| *y + *k * f).collect()
    };
    let k1 = rate(t, y);
    let k2 = rate(t + dt / 2.0, &add(y, &k1, dt / 2.0));
    let k3 = rate(t + dt / 2.0, &add(y, &k2, dt / 2.0));
    let k4 = rate(t + dt, &add(y, &k3, dt));
    let shares = [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)];
    let add_share = |y: Vec<T>, (k, f): &(Vec<T>, f64)| add(&y, k, f * dt / 6.0);
    shares.iter().fold(y.to_vec(), add_share)
}
