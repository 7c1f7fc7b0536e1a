//! The number type of the model equations: `f64`, or dual numbers for exact derivatives.
#![forbid(unsafe_code)]

use nalgebra::RealField;

/// A real scalar. All model equations are generic over it, so that directional derivatives are
/// the equations themselves evaluated in dual numbers ([`num_dual::Dual64`]).
pub trait Scalar: RealField + Copy + From<f64> {}

impl<T: RealField + Copy + From<f64>> Scalar for T {}

/// The constant `x` as a scalar.
#[inline(always)]
pub fn constant<T: Scalar>(x: f64) -> T {
    T::from(x)
}
