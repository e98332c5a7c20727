//! Quadrature of the elements: Gauss-Legendre points and weights, and the shape functions there.

/// Most nodes of an element.
pub const MAX_NODES: usize = 20;

/// Most nodes of a face.
pub const MAX_FACE_NODES: usize = 8;

/// A value and gradient of every shape function at one point of quadrature.
pub(crate) struct Station {
    pub weight: f64,
    pub value: [f64; MAX_NODES],
    pub gradient: [[f64; 3]; MAX_NODES],
}

/// Points and weights of Gauss-Legendre quadrature on (−1, 1).
pub(super) const GAUSS_3: [[f64; 2]; 3] = [
    [-0.774_596_669_241_483_4, 5.0 / 9.0],
    [0.0, 8.0 / 9.0],
    [0.774_596_669_241_483_4, 5.0 / 9.0],
];

/// Four points.
pub(super) const GAUSS_4: [[f64; 2]; 4] = [
    [-0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
    [-0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.339_981_043_584_856_26, 0.652_145_154_862_546_1],
    [0.861_136_311_594_052_6, 0.347_854_845_137_453_85],
];
