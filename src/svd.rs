//! Singular value decomposition of small matrices by one-sided Jacobi rotations.
//!
//! The library's own `svd` returns factors whose product is not the matrix for a good part of the
//! near-singular ones (nalgebra issue 1172; it misses the Jacobian by up to 0.1 at direct
//! singularities), the very case this project lives on. Jacobi's method has no such case, and
//! gives small singular values and their vectors to high relative accuracy: Demmel, J., Veselic,
//! K.: Jacobi's Method is More Accurate than QR, SIAM J. Matrix Anal. Appl. 13 (1992),
//! doi:10.1137/0613074.
#![forbid(unsafe_code)]

use nalgebra::{SMatrix, SVector};

/// A = U diag(singular_values) V^T of a matrix with at least as many rows as columns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Svd<const R: usize, const C: usize> {
    /// Left singular vectors; the zero vector where the singular value is zero.
    pub u: SMatrix<f64, R, C>,
    /// In descending order.
    pub singular_values: SVector<f64, C>,
    /// Right singular vectors.
    pub v: SMatrix<f64, C, C>,
}

/// Columns count as orthogonal when the cosine of their angle is below this.
const ORTHOGONAL: f64 = 2.0 * f64::EPSILON;
/// Convergence is quadratic; a dozen sweeps has been the most over millions of matrices of this size.
const MAX_SWEEPS: usize = 40;

impl<const R: usize, const C: usize> Svd<R, C> {
    /// Of a finite matrix.
    pub fn new(matrix: &SMatrix<f64, R, C>) -> Self {
        let mut columns = *matrix;
        let mut v = SMatrix::<f64, C, C>::identity();
        orthogonalize(&mut columns, |p, q, rotation| rotate(&mut v, p, q, rotation));
        let norms: [f64; C] = std::array::from_fn(|k| columns.column(k).norm());
        let mut order: [usize; C] = std::array::from_fn(|k| k);
        order.sort_by(|&p, &q| norms[q].total_cmp(&norms[p]));
        Self {
            u: SMatrix::from_fn(|row, k| {
                let norm = norms[order[k]];
                if norm > 0.0 { columns[(row, order[k])] / norm } else { 0.0 }
            }),
            singular_values: SVector::from_fn(|k, _| norms[order[k]]),
            v: SMatrix::from_fn(|row, k| v[(row, order[k])]),
        }
    }

    /// Ratio of the largest to the smallest singular value; a smallest one below the rounding
    /// error counts as that, so the ratio is finite.
    pub fn condition(&self) -> f64 {
        let (largest, smallest) = (self.singular_values[0], self.singular_values[C - 1]);
        if largest > 0.0 { largest / smallest.max(f64::EPSILON * largest) } else { 1.0 / f64::EPSILON }
    }

    /// Number of singular values above `cutoff` times the largest.
    pub fn rank(&self, cutoff: f64) -> usize {
        self.singular_values.iter().filter(|&&s| s > cutoff * self.singular_values[0]).count()
    }

    /// The pseudo-inverse, singular values up to `cutoff` times the largest taken as zero.
    pub fn pseudo_inverse(&self, cutoff: f64) -> SMatrix<f64, C, R> {
        let mut inverse = SMatrix::zeros();
        for k in 0..self.rank(cutoff) {
            inverse += self.v.column(k) * self.u.column(k).transpose() / self.singular_values[k];
        }
        inverse
    }
}

/// The smallest singular value of a finite matrix, the same number as [`Svd::new`] finds.
pub fn smallest_singular_value<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> f64 {
    let mut columns = *matrix;
    orthogonalize(&mut columns, |_, _, _| {});
    columns.column_iter().map(|column| column.norm()).min_by(f64::total_cmp).unwrap_or(0.0)
}

/// Makes the columns orthogonal by rotating pairs of them, and tells each rotation (columns, cosine
/// and sine).
#[inline(always)]
fn orthogonalize<const R: usize, const C: usize>(
    columns: &mut SMatrix<f64, R, C>,
    mut rotated_by: impl FnMut(usize, usize, (f64, f64)),
) {
    const { assert!(R >= C, "decompose the transpose of a wide matrix") };
    for _ in 0..MAX_SWEEPS {
        let mut rotated = false;
        for p in 0..C {
            for q in p + 1..C {
                if let Some(rotation) = orthogonalizing(columns, p, q) {
                    rotate(columns, p, q, rotation);
                    rotated_by(p, q, rotation);
                    rotated = true;
                }
            }
        }
        if !rotated {
            break;
        }
    }
}

/// (cosine, sine) of the rotation that makes columns `p` and `q` orthogonal, if they are not.
fn orthogonalizing<const R: usize, const C: usize>(
    columns: &SMatrix<f64, R, C>,
    p: usize,
    q: usize,
) -> Option<(f64, f64)> {
    let product = columns.column(p).dot(&columns.column(q));
    let (square_p, square_q) = (columns.column(p).norm_squared(), columns.column(q).norm_squared());
    if product.abs() <= ORTHOGONAL * (square_p * square_q).sqrt() {
        return None;
    }
    let cot_double = (square_q - square_p) / (2.0 * product);
    let tan = 1.0f64.copysign(cot_double) / (cot_double.abs() + (1.0 + cot_double * cot_double).sqrt());
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    Some((cos, cos * tan))
}

fn rotate<const R: usize, const C: usize>(matrix: &mut SMatrix<f64, R, C>, p: usize, q: usize, (cos, sin): (f64, f64)) {
    for row in 0..R {
        let (x, y) = (matrix[(row, p)], matrix[(row, q)]);
        matrix[(row, p)] = cos * x - sin * y;
        matrix[(row, q)] = sin * x + cos * y;
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Matrix6, Matrix6x3};
    use proptest::prelude::*;

    use super::*;

    fn check<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> Svd<R, C> {
        let svd = Svd::new(matrix);
        let scale = matrix.amax().max(f64::MIN_POSITIVE);
        let product = svd.u * SMatrix::from_diagonal(&svd.singular_values) * svd.v.transpose();
        assert!((product - matrix).amax() < 2e-15 * R as f64 * scale);
        assert!((svd.v.tr_mul(&svd.v) - SMatrix::identity()).amax() < 1e-14);
        let gram = svd.u.tr_mul(&svd.u);
        for p in 0..C {
            for q in 0..C {
                let expected = if p == q && svd.singular_values[p] > 0.0 { 1.0 } else { 0.0 };
                assert!((gram[(p, q)] - expected).abs() < 1e-14);
            }
        }
        assert!(svd.singular_values.as_slice().windows(2).all(|pair| pair[0] >= pair[1]));
        assert_eq!(smallest_singular_value(matrix), svd.singular_values[C - 1]);
        svd
    }

    proptest! {
        #[test]
        fn factors_multiply_to_the_matrix_however_close_to_singular(
            elements in prop::array::uniform32(-1.0..1.0_f64), exponent in -20.0..0.0_f64, zero in any::<bool>(),
        ) {
            let mut matrix = Matrix6::from_fn(|i, j| elements[(6 * i + j) % 32]);
            // the last column almost a combination of two others
            let deviation = matrix.column(5) * if zero { 0.0 } else { 10f64.powf(exponent) };
            let column = matrix.column(0) * 0.3 - matrix.column(3) * 0.7 + deviation;
            matrix.set_column(5, &column);
            let determinant = matrix.determinant().abs();
            let svd = check(&matrix);
            prop_assert!((svd.singular_values.product() - determinant).abs() < 1e-13);
            check(&matrix.transpose());
        }

        #[test]
        fn pseudo_inverse_fulfils_penrose_s_conditions(elements in prop::array::uniform18(-1.0..1.0_f64)) {
            let a = Matrix6x3::from_column_slice(&elements);
            let svd = check(&a);
            prop_assume!(svd.condition() < 1e4);
            let x = svd.pseudo_inverse(1e-9);
            prop_assert!((a * x * a - a).amax() < 1e-10);
            prop_assert!((x * a - Matrix3::identity()).amax() < 1e-10);
            prop_assert!((a * x - (a * x).transpose()).amax() < 1e-10);
        }
    }

    #[test]
    fn degenerate_matrices() {
        assert_eq!(check(&Matrix6::zeros()).rank(1e-9), 0);
        assert_eq!(check(&Matrix6::from_element(1.0)).rank(1e-9), 1);
        assert_eq!(check(&Matrix6::identity()).singular_values, SVector::<f64, 6>::from_element(1.0));
        assert!(check(&Matrix6::zeros()).condition().is_finite());
    }

    #[test]
    fn a_small_singular_value_keeps_its_digits() {
        // D1 Q D2: the relative accuracy that a bidiagonalization would lose
        let matrix = Matrix3::new(1.0, 1.0, 1e-12, 1.0, -1.0, 1e-12, 1.0, 0.0, -2e-12);
        let svd = Svd::new(&matrix);
        let expected = matrix.determinant().abs() / (svd.singular_values[0] * svd.singular_values[1]);
        assert!((svd.singular_values[2] / expected - 1.0).abs() < 1e-14);
    }
}
