//! The number type of the model equations: `f64`, or dual numbers for exact derivatives.
#![forbid(unsafe_code)]

use nalgebra::RealField;
use num_dual::{Dual2_64, Dual64};

/// A real scalar. All model equations are generic over it, so that directional derivatives are
/// the equations themselves evaluated in dual numbers ([`num_dual::Dual64`]).
///
/// The transcendental functions are here because those of `Dual64` end in the platform's C library,
/// whose last bits differ from system to system. These are libm's everywhere.
pub trait Scalar: RealField + Copy + From<f64> {
    /// Sine and cosine of an angle in rad.
    fn sine_cosine(self) -> (Self, Self);

    /// The angle of the point (`x`, `self`) from the first axis, rad, in (-pi, pi].
    fn angle_beside(self, x: Self) -> Self;
}

impl Scalar for f64 {
    #[inline]
    fn sine_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }

    #[inline]
    fn angle_beside(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
}

impl Scalar for Dual64 {
    #[inline]
    fn sine_cosine(self) -> (Self, Self) {
        let (sin, cos) = libm::sincos(self.re);
        (Self::new(sin, cos * self.eps), Self::new(cos, -sin * self.eps))
    }

    #[inline]
    fn angle_beside(self, x: Self) -> Self {
        let square = x.re * x.re + self.re * self.re;
        Self::new(libm::atan2(self.re, x.re), (x.re * self.eps - self.re * x.eps) / square)
    }
}

/// Second derivatives, for analysis: the last bits are the platform's.
impl Scalar for Dual2_64 {
    fn sine_cosine(self) -> (Self, Self) {
        nalgebra::ComplexField::sin_cos(self)
    }

    fn angle_beside(self, x: Self) -> Self {
        RealField::atan2(self, x)
    }
}

/// The constant `x` as a scalar.
#[inline(always)]
pub fn constant<T: Scalar>(x: f64) -> T {
    T::from(x)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn derivative_of_the_angle_along_the_circle_is_one() {
        for angle in [-3.0, -1.5, -1e-9, 0.0, 0.7, 3.1] {
            let (sin, cos) = Dual64::new(angle, 1.0).sine_cosine();
            assert_relative_eq!(sin.eps, cos.re);
            assert_relative_eq!(cos.eps, -sin.re);
            let found = sin.angle_beside(cos);
            assert_relative_eq!(found.re, angle, max_relative = 1e-15);
            assert_relative_eq!(found.eps, 1.0, max_relative = 1e-15);
        }
    }

    #[test]
    fn value_of_a_dual_number_is_the_real_numbers_to_the_bit() {
        for angle in [-2.9, 0.1, 1.3] {
            let (sin, cos) = angle.sine_cosine();
            let (dual_sin, dual_cos) = Dual64::from(angle).sine_cosine();
            assert_eq!([dual_sin.re, dual_cos.re], [sin, cos]);
            assert_eq!(dual_sin.angle_beside(dual_cos).re, sin.angle_beside(cos));
        }
    }
}
