//! The smallest singular value, in any number type.

use nalgebra::Matrix6;
use num_dual::Dual64;

use crate::scalar::Scalar;
use crate::svd::{Svd, smallest_singular_value};

/// A scalar whose matrices have a smallest singular value that can be computed.
pub trait SingularValues: Scalar {
    /// Smallest singular value of `matrix`.
    fn sigma_min(matrix: &Matrix6<Self>) -> Self;
}

impl SingularValues for f64 {
    fn sigma_min(matrix: &Matrix6<f64>) -> f64 {
        smallest_singular_value(matrix)
    }
}

impl SingularValues for Dual64 {
    /// d(sigma) = u^T dJ v
    fn sigma_min(matrix: &Matrix6<Dual64>) -> Dual64 {
        let Svd { u, singular_values, v } = Svd::new(&matrix.map(|x| x.re));
        Dual64::new(singular_values[5], u.column(5).dot(&(matrix.map(|x| x.eps) * v.column(5))))
    }
}
