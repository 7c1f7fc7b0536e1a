//! The exponential map of rotations and its derivatives, regular at zero angle.

use nalgebra::{Matrix3, Vector3};

use crate::scalar::{Scalar, constant};

/// With t the rotation angle and u = t^2, the coefficients of
/// `exp([phi]x) = I + a [phi]x + b [phi]x^2` and of its left Jacobian `I + b [phi]x + c [phi]x^2`,
/// and what is needed of their derivatives with respect to u.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExponentialCoefficients<T> {
    /// sin t / t
    pub a: T,
    /// (1 - cos t) / t^2
    pub b: T,
    /// (t - sin t) / t^3
    pub c: T,
    /// db / du
    pub b_u: T,
    /// d2b / du2
    pub b_uu: T,
    /// dc / du
    pub c_u: T,
}

/// Up to here (57 deg) the power series in u is used: with ten terms its remainder, at most
/// u^10 / 22!, is far below the rounding error, and it has no 0/0 at u = 0.
const SERIES_LIMIT: f64 = 1.0;
const SERIES_TERMS: usize = 10;

/// Coefficients (-1)^k / (2k + offset)! of the series of b (offset 2) and c (offset 3).
const fn series(offset: usize) -> [f64; SERIES_TERMS] {
    let mut result = [0.0; SERIES_TERMS];
    let mut factorial = if offset == 2 { 2.0 } else { 6.0 };
    let mut sign = 1.0;
    let mut k = 0;
    while k < SERIES_TERMS {
        result[k] = sign / factorial;
        sign = -sign;
        let n = (2 * k + offset) as f64;
        factorial *= (n + 1.0) * (n + 2.0);
        k += 1;
    }
    result
}

const B_SERIES: [f64; SERIES_TERMS] = series(2);
const C_SERIES: [f64; SERIES_TERMS] = series(3);

impl<T: Scalar> ExponentialCoefficients<T> {
    /// At squared angle `u` >= 0, rad^2.
    #[inline]
    pub fn at(u: T) -> Self {
        if u < constant(SERIES_LIMIT) { Self::by_series(u) } else { Self::closed_form(u) }
    }

    #[inline]
    fn by_series(u: T) -> Self {
        // Horner's scheme with derivatives
        let (mut b, mut b_u, mut half_b_uu) = (T::zero(), T::zero(), T::zero());
        let (mut c, mut c_u) = (T::zero(), T::zero());
        for k in (0..SERIES_TERMS).rev() {
            half_b_uu = half_b_uu * u + b_u;
            b_u = b_u * u + b;
            b = b * u + constant(B_SERIES[k]);
            c_u = c_u * u + c;
            c = c * u + constant(C_SERIES[k]);
        }
        Self { a: T::one() - u * c, b, c, b_u, b_uu: half_b_uu + half_b_uu, c_u }
    }

    fn closed_form(u: T) -> Self {
        let t = u.sqrt();
        let (sin, cos) = t.sine_cosine();
        let two = constant::<T>(2.0);
        let a = sin / t;
        let b = (T::one() - cos) / u;
        let c = (T::one() - a) / u;
        let a_u = (cos - a) / (two * u);
        let b_u = (a - two * b) / (two * u);
        let b_uu = (a_u - constant::<T>(4.0) * b_u) / (two * u);
        let c_u = -(a_u + c) / u;
        Self { a, b, c, b_u, b_uu, c_u }
    }
}

/// The rotation vector phi (rad) of the rotation matrix `r`, angle in [0, pi).
pub fn rotation_vector<T: Scalar>(r: &Matrix3<T>) -> Vector3<T> {
    let half = constant::<T>(0.5);
    let sine_axis = Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12) * half;
    let square = sine_axis.norm_squared();
    if square < constant(1e-18) {
        return sine_axis;
    }
    let sin = square.sqrt();
    sine_axis * (sin.angle_beside(half * (r.trace() - T::one())) / sin)
}

#[cfg(test)]
mod tests {
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    use super::*;

    #[test]
    fn series_and_closed_form_agree_where_both_hold() {
        for u in [0.3, 0.6, 0.99, 1.0] {
            let (s, f) = (ExponentialCoefficients::by_series(u), ExponentialCoefficients::<f64>::closed_form(u));
            for (x, y) in [(s.a, f.a), (s.b, f.b), (s.c, f.c), (s.b_u, f.b_u), (s.b_uu, f.b_uu), (s.c_u, f.c_u)] {
                // the closed form of b_uu cancels twice, dividing rounding errors of 1e-16 by u^2
                assert_abs_diff_eq!(x, y, epsilon = 1e-14);
            }
        }
    }

    #[test]
    fn rotation_vector_inverts_the_exponential_map() {
        for phi in [Vector3::new(0.1, -0.2, 0.3), Vector3::new(1e-12, 0.0, 0.0), Vector3::new(1.5, 2.0, -0.4)] {
            let r = nalgebra::Rotation3::new(phi);
            assert_relative_eq!(rotation_vector(r.matrix()), phi, max_relative = 1e-9, epsilon = 1e-15);
        }
    }
}
