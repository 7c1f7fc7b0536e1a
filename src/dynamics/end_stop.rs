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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use num_dual::Dual64;

    use super::*;

    const WIDE: f64 = 2e-3;

    fn stop<T: Scalar>() -> EndStop<T> {
        let [min, max, stiffness, damping, width] = [-0.5, 0.5, 1e5, 300.0, WIDE].map(constant);
        EndStop { min, max, stiffness, damping, width }
    }

    #[test]
    fn force_at_rest_is_the_loss_of_elastic_energy() {
        for k in -60..=60 {
            let penetration = f64::from(k) * WIDE / 20.0;
            for position in [0.5 + penetration, -0.5 - penetration] {
                let energy = stop().energy(Dual64::new(position, 1.0));
                assert!((energy.re - stop::<f64>().energy(position)).abs() < 1e-12);
                let force = stop().force(position, 0.0);
                assert!((force + energy.eps).abs() < 1e-9, "{position}: {force} {}", energy.eps);
            }
        }
    }

    #[test]
    fn elastic_energy_goes_on_where_the_width_ends() {
        let energy = |penetration: f64| stop().energy(0.5 + penetration);
        // k w^2 / 6, and from there on at k (p - w/2)
        let (at_width, gain) = (1e5 * WIDE * WIDE / 6.0, 1e5 * WIDE * WIDE);
        assert!((energy(WIDE * (1.0 - 1e-12)) - at_width).abs() < 1e-9);
        assert!((energy(WIDE * (1.0 + 1e-12)) - at_width).abs() < 1e-9);
        assert!((energy(2.0 * WIDE) - at_width - gain).abs() < 1e-9);
    }

    #[test]
    fn stiffness_grows_over_the_width_and_is_the_parameter_s_beyond() {
        let push = |penetration: f64| stop().force(-0.5 - penetration, 0.0);
        assert_eq!(push(0.0), 0.0);
        assert!((push(0.5 * WIDE) - 1e5 * WIDE / 8.0).abs() < 1e-9);
        assert!((push(WIDE) - 1e5 * WIDE / 2.0).abs() < 1e-9);
        assert!((push(3.0 * WIDE) - push(2.0 * WIDE) - 1e5 * WIDE).abs() < 1e-9);
    }

    #[test]
    fn damping_opposes_the_motion_and_a_stop_never_pulls() {
        for side in [1.0, -1.0] {
            let force = |rate: f64| side * stop().force(side * (0.5 + 2.0 * WIDE), side * rate);
            assert!((force(0.1) - force(0.0) + 30.0).abs() < 1e-9, "approaching: pushed back harder");
            assert!((force(-0.1) - force(0.0) - 30.0).abs() < 1e-9, "leaving: less hard");
            assert_eq!(force(-10.0), 0.0, "too fast for the spring to follow");
        }
    }
    #[test]
    fn a_limb_s_stop_is_one_of_lengths_at_the_joint_radius() {
        let parameters = PlantParameters::<f64>::default();
        let EndStops { length, angle, .. } = EndStops::new(&parameters);
        let lever = Geometry::new(parameters.mechanism.base_radius, parameters.mechanism.joint_spacing).joint_radius;
        for penetration in [0.0, 1e-4, 5e-4, 2e-3, 1e-2] {
            for rate in [-0.1, 0.0, 0.1] {
                let force = length.force(parameters.d_max + penetration, rate);
                let torque = angle.force(parameters.theta_max + penetration / lever, rate / lever);
                assert!((torque - force * lever).abs() < 1e-9 * (1.0 + force.abs()), "{penetration} {rate}: {torque}");
            }
        }
    }

    #[test]
    fn stops_of_limbs_are_felt_at_every_angle_beyond_the_limits_and_at_no_other() {
        for (theta_min, theta_max) in [(0.1, 1.2), (-0.3, 0.4), (0.1, 2.0)] {
            let stops = EndStops::new(&PlantParameters { theta_min, theta_max, ..PlantParameters::default() });
            for k in -314..314 {
                let angle = 0.01 * f64::from(k) + 0.005;
                let (sin, cos) = angle.sin_cos();
                let nowhere = Vector3::zeros();
                let limb = Limb {
                    sin,
                    cos,
                    length: 0.3,
                    arm: nowhere,
                    axial: nowhere,
                    normal: nowhere,
                    lateral: nowhere,
                    length_gradient: nowhere,
                    angle_gradient: nowhere,
                };
                let torque = stops.torque(&limb, 0.0);
                assert_eq!(torque > 0.0, angle < theta_min, "{angle}");
                assert_eq!(torque < 0.0, angle > theta_max, "{angle}");
                assert!((torque - stops.angle.force(angle, 0.0)).abs() <= 1e-9 * torque.abs(), "{angle}");
            }
        }
    }
}
