//! The loop closure (2.4), (2.5) and its matrices A and B (Appendix B).

use nalgebra::Matrix3;

use super::super::{Geometry, Limb};
use crate::scalar::{Scalar, constant};

/// The spherical joints of the pairs (2.4), row by row.
const PAIRS: [(usize, usize); 3] = [(0, 1), (1, 2), (2, 0)];

/// Matrix A of (2.5), (B.1): derivative of the squared joint distances (2.4) with respect to the
/// limb angles. Lengths divided by a, so dimensionless.
///
/// The paper measures the angle outwards, theta' = 180 deg - theta, so that e_i = 1 + d_i cos theta'_i;
/// all limbs are 120 deg apart, so cos(alpha_j - alpha_i) = -1/2.
pub fn matrix_a<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> Matrix3<T> {
    let cos_between = constant::<T>(-0.5);
    let (outward, height) = components(geometry, limbs);
    by_pairs(|i, j| {
        constant::<T>(2.0) * (cos_between * (height[i] + height[i] * outward[j]) - (height[i] + height[j] * outward[i]))
    })
}

/// Matrix B of (2.5), (B.2): derivative of the squared joint distances (2.4) with respect to the
/// limb lengths. Lengths divided by a, so dimensionless.
pub fn matrix_b<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> Matrix3<T> {
    let (outward, height) = components(geometry, limbs);
    by_pairs(|i, j| {
        // cos theta' = -cos theta, sin theta' = sin theta
        let (cos, sin) = (-limbs[i].cos, limbs[i].sin);
        let length = limbs[i].length / geometry.base_radius;
        cos * (outward[j] + T::one()) + constant::<T>(2.0) * (length + cos - sin * height[j])
    })
}

/// det A (2.11), lengths divided by a; zero exactly at direct singularities.
pub fn normalized_det_a<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> T {
    let a = matrix_a(geometry, limbs);
    a.m11 * a.m22 * a.m33 + a.m12 * a.m23 * a.m31
}

/// d_i cos theta'_i and d_i sin theta'_i over a (2.6).
fn components<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> ([T; 3], [T; 3]) {
    let scaled = |limb: &Limb<T>| limb.length / geometry.base_radius;
    (limbs.map(|limb| -scaled(&limb) * limb.cos), limbs.map(|limb| scaled(&limb) * limb.sin))
}

/// The matrix whose row for the pair (i, j) holds `element(i, j)` in column i, `element(j, i)` in column j.
fn by_pairs<T: Scalar>(element: impl Fn(usize, usize) -> T) -> Matrix3<T> {
    let mut matrix = Matrix3::zeros();
    for (row, (i, j)) in PAIRS.into_iter().enumerate() {
        matrix[(row, i)] = element(i, j);
        matrix[(row, j)] = element(j, i);
    }
    matrix
}
