//! Damping factors and the damped acceleration in matrix form.

use nalgebra::{SMatrix, SVector};
use serde::{Deserialize, Serialize};

use crate::scalar::{Scalar, constant};

/// Control modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// Resolved acceleration, undamped (4.5).
    Rac,
    /// Damped acceleration: rho fixed, rho_hd = 0.
    Drac,
    /// Hybrid: damped acceleration and velocity with fixed factors (4.14)-(4.16).
    Hdrac,
    /// Hybrid, the factors found by the modified particle swarm.
    HdracMpso,
}

impl Mode {
    /// The damping of a mode that does not search for it, from the `fixed` factors.
    pub fn fixed_damping<T: Scalar>(self, fixed: &Damping<T>) -> Option<Damping<T>> {
        match self {
            Self::Rac => Some(Damping { rho: T::zero(), delta_hd: T::zero(), lambda_f: T::zero() }),
            Self::Drac => Some(Damping { delta_hd: T::zero(), ..*fixed }),
            Self::Hdrac => Some(*fixed),
            Self::HdracMpso => None,
        }
    }
}

/// Damping factors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Damping<T> {
    /// rho (4.11), dimensionless.
    pub rho: T,
    /// Width delta_hd of the deceleration region (4.16), dimensionless.
    pub delta_hd: T,
    /// Damping of the force distribution of three motors, dimensionless.
    pub lambda_f: T,
}

/// Keeps 1 / (sigma^2 + rho^2) finite at an exact singularity without damping; far below what
/// rounding leaves of sigma^2 anywhere else.
pub const SMALLEST_SQUARE: f64 = 1e-18;

/// In place of a sigma_min of zero, so that there is a delta_hd (4.16) to every rho_hd, and back.
pub const SMALLEST_SIGMA: f64 = f64::MIN_POSITIVE;

impl<T: Scalar> Damping<T> {
    /// rho_hd (4.16), 1/s, at the smallest singular value `sigma_min`.
    #[inline]
    pub fn rho_hd(&self, sigma_min: T, sample_time: T) -> T {
        let sigma_min = sigma_min.max(constant(SMALLEST_SIGMA));
        if sigma_min < self.delta_hd { (T::one() - sigma_min / self.delta_hd) / sample_time } else { T::zero() }
    }

    /// The damped acceleration (4.14), m/s2, in matrix form: from J, the desired joint-side
    /// acceleration a_d* (m/s2) and the twist q_dot (m/s), in all `N` = 6 components or in those
    /// `N` = 3 that the mechanism allows. `None` if J is singular and undamped.
    ///
    /// [`super::SingularBasis`] is the same by singular values (4.10), (4.15) and cheaper for many
    /// dampings; this form can be differentiated through.
    pub fn acceleration<const N: usize>(
        &self,
        jacobian: &SMatrix<T, N, N>,
        desired: &SVector<T, N>,
        twist: &SVector<T, N>,
        rho_hd: T,
    ) -> Option<SVector<T, N>> {
        let square = self.rho * self.rho;
        let gram = jacobian.tr_mul(jacobian) + SMatrix::identity() * (square + constant(SMALLEST_SQUARE));
        let right = jacobian.tr_mul(desired) - twist * (rho_hd * square);
        gram.cholesky().map(|factor| factor.solve(&right))
    }
}
