//! The smallest singular value, in any number type.

use nalgebra::Matrix6;
use num_dual::Dual64;

use crate::scalar::Scalar;

/// A scalar whose matrices have a smallest singular value that can be computed.
pub trait SingularValues: Scalar {
    /// Smallest singular value of `matrix`.
    fn sigma_min(matrix: &Matrix6<Self>) -> Self;
}

impl SingularValues for f64 {
    fn sigma_min(matrix: &Matrix6<f64>) -> f64 {
        matrix.singular_values_unordered().min()
    }
}

impl SingularValues for Dual64 {
    /// d(sigma) = u^T dJ v
    fn sigma_min(matrix: &Matrix6<Dual64>) -> Dual64 {
        let svd = matrix.map(|x| x.re).svd_unordered(true, true);
        let smallest = svd.singular_values.imin();
        let derivative = match (svd.u, svd.v_t) {
            (Some(u), Some(v_t)) => u.column(smallest).dot(&(matrix.map(|x| x.eps) * v_t.row(smallest).transpose())),
            _ => f64::NAN,
        };
        Dual64::new(svd.singular_values[smallest], derivative)
    }
}
