//! Direct kinematic singularities by the loop closure (2.4), (2.5) and Appendix B.

use nalgebra::Matrix3;

use super::{Geometry, Limb};
use crate::scalar::{Scalar, constant};

/// Matrix A of (2.5), (B.1): derivative of the squared joint distances (2.4) with respect to the
/// limb angles. Lengths divided by a, so dimensionless.
///
/// The paper measures the angle outwards, theta' = 180 deg - theta, so that e_i = 1 + d_i cos theta'_i;
/// all limbs are 120 deg apart, so cos(alpha_j - alpha_i) = -1/2.
pub fn matrix_a<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> Matrix3<T> {
    let cos_between = constant::<T>(-0.5);
    // d_i sin theta'_i and d_i cos theta'_i over a
    let height = |i: usize| limbs[i].length * limbs[i].sin / geometry.base_radius;
    let outward = |i: usize| -limbs[i].length * limbs[i].cos / geometry.base_radius;
    // the pair (i, j), differentiated with respect to theta'_i
    let element = |i: usize, j: usize| {
        let (z_i, z_j, x_i, x_j) = (height(i), height(j), outward(i), outward(j));
        constant::<T>(2.0) * (cos_between * (z_i + z_i * x_j) - (z_i + z_j * x_i))
    };
    let zero = T::zero();
    Matrix3::new(
        element(0, 1),
        element(1, 0),
        zero, //
        zero,
        element(1, 2),
        element(2, 1), //
        element(0, 2),
        zero,
        element(2, 0),
    )
}

/// det A (2.11), lengths divided by a; zero exactly at direct singularities.
pub fn normalized_det_a<T: Scalar>(geometry: &Geometry<T>, limbs: &[Limb<T>; 3]) -> T {
    let a = matrix_a(geometry, limbs);
    a.m11 * a.m22 * a.m33 + a.m12 * a.m23 * a.m31
}
