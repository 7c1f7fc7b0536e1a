//! Smooth one-sided end stops of limb lengths and angles.

use super::PlantParameters;
use crate::mechanism::{Geometry, Limb};
use crate::scalar::{Scalar, constant};

/// Limits of one joint coordinate with stiffness and damping beyond them.
///
/// With penetration p > 0 the stop pushes back with k p^2 / (2 w) up to p = w and k (p - w/2) from
/// there on, plus damping that fades in over the same width w; it never pulls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStop<T> {
    min: T,
    max: T,
    /// N/m or N.m/rad
    stiffness: T,
    /// N.s/m or N.m.s/rad
    damping: T,
    /// m or rad
    width: T,
}

/// Width w of the transition for lengths, m.
const WIDTH: f64 = 1e-3;

impl<T: Scalar> EndStop<T> {
    /// Force (N) or torque (N.m) on the joint at `position` and `rate`.
    #[inline]
    pub fn force(&self, position: T, rate: T) -> T {
        if position > self.max {
            -self.push(position - self.max, rate)
        } else if position < self.min {
            self.push(self.min - position, -rate)
        } else {
            T::zero()
        }
    }

    fn push(&self, penetration: T, rate: T) -> T {
        let half = constant::<T>(0.5);
        let (spring, fade) = if penetration < self.width {
            (half * penetration * penetration / self.width, penetration / self.width)
        } else {
            (penetration - half * self.width, T::one())
        };
        let force = self.stiffness * spring + self.damping * fade * rate;
        if force > T::zero() { force } else { T::zero() }
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: T) -> T {
        let penetration = if position > self.max {
            position - self.max
        } else if position < self.min {
            self.min - position
        } else {
            return T::zero();
        };
        let (half, sixth) = (constant::<T>(0.5), constant::<T>(1.0 / 6.0));
        let p = penetration;
        let w = self.width;
        self.stiffness * if p < w { sixth * p * p * p / w } else { half * p * p - half * w * p + sixth * w * w }
    }
}

/// The stops of all limbs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndStops<T> {
    /// Of the limb lengths.
    pub length: EndStop<T>,
    /// Of the limb angles; stiffness, damping and width at a lever r_b.
    pub angle: EndStop<T>,
    /// Sines between which an inward limb is within its limits for sure.
    free_sines: (T, T),
}

impl<T: Scalar> EndStops<T> {
    pub(super) fn new(parameters: &PlantParameters<T>) -> Self {
        let lever = Geometry::new(parameters.mechanism.base_radius, parameters.mechanism.joint_spacing).joint_radius;
        let stop = |min, max, lever: T| EndStop {
            min,
            max,
            stiffness: parameters.stop_stiffness * lever * lever,
            damping: parameters.stop_damping * lever * lever,
            width: constant::<T>(WIDTH) / lever,
        };
        let quarter_turn = constant::<T>(std::f64::consts::FRAC_PI_2);
        let sine = |angle: T| angle.max(-quarter_turn).min(quarter_turn).sine_cosine().0;
        Self {
            length: stop(parameters.d_min, parameters.d_max, T::one()),
            angle: stop(parameters.theta_min, parameters.theta_max, lever),
            free_sines: (sine(parameters.theta_min), sine(parameters.theta_max)),
        }
    }

    /// Torque on a limb's revolute joint, N.m. The angle itself is computed only near a stop.
    #[inline]
    pub fn torque(&self, limb: &Limb<T>, rate: T) -> T {
        let (low, high) = self.free_sines;
        if limb.cos > T::zero() && limb.sin > low && limb.sin < high {
            return T::zero();
        }
        self.angle.force(limb.angle(), rate)
    }
}
