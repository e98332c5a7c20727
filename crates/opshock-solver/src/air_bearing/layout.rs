//! Where the grid lines go.

use crate::grid::Lines;
use crate::slider::surface::Surface;

/// Grid lines along x and y through all edges of `surface`, about `cells` cells in all.
pub(super) fn lines(surface: &Surface, cells: usize) -> [Lines; 2] {
    let edges = surface.edge_coordinates_m();
    let target = (cells as f64).sqrt();
    edges.map(|edges| graded(&edges, target))
}

fn graded(edges: &[f64], target: f64) -> Lines {
    let total = edges[edges.len() - 1] - edges[0];
    let weight: f64 = edges
        .windows(2)
        .map(|w| ((w[1] - w[0]) / total).sqrt())
        .sum();
    let mut lines = vec![edges[0]];
    for w in edges.windows(2) {
        let n = ((target * ((w[1] - w[0]) / total).sqrt() / weight).round() as usize).max(1);
        for k in 1..n {
            let s = k as f64 / n as f64;
            let t = 0.5 - 0.5 * (std::f64::consts::PI * s).cos();
            lines.push(w[0] + (w[1] - w[0]) * t);
        }
        lines.push(w[1]);
    }
    Lines::new(lines).expect("edges rise strictly")
}
