//! The Lyapunov function of section 5.

use super::{Gains, Situation};
use crate::scalar::{Scalar, constant};

/// L (5.2), m2/s2: with the joint-side error x_r - x, all gains alike, and rho in force.
pub fn lyapunov<T: Scalar>(situation: &Situation<T>, gains: &Gains<T>, rho: T) -> T {
    let half = constant::<T>(0.5);
    let rate = situation.jacobian * situation.twist;
    half * gains.position * situation.error.norm_squared()
        + half * (rate.norm_squared() + rho * rho * situation.twist.norm_squared())
}

/// dL/dt (5.5), m2/s3, which is (5.6) while the reference rests. It assumes ideal computed torque,
/// constant rho and no acceleration feedback.
pub fn lyapunov_rate<T: Scalar>(situation: &Situation<T>, gains: &Gains<T>, rho: T, rho_hd: T) -> T {
    let rate = situation.jacobian * situation.twist;
    let rate_error = situation.reference_rate - rate;
    gains.position * situation.error.dot(&situation.reference_rate)
        + rate.dot(&situation.reference_acceleration)
        + gains.velocity * rate.dot(&rate_error)
        - rho_hd * rho * rho * situation.twist.norm_squared()
}
