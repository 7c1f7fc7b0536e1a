//! Reference trajectories in the generalized coordinates s = (heave, tilt_x, tilt_y).

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

use super::ControllerParameters;
use crate::mechanism::Geometry;
use crate::scalar::{Scalar, constant};

/// A reference at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReferencePoint<T> {
    /// (heave in m, tilt_x, tilt_y in rad).
    pub position: Vector3<T>,
    /// Its rate, m/s and rad/s.
    pub rate: Vector3<T>,
    /// Its acceleration, m/s2 and rad/s2.
    pub acceleration: Vector3<T>,
}

impl<T: Scalar> Default for ReferencePoint<T> {
    /// At rest at the origin: for a controller with a path of its own.
    fn default() -> Self {
        Self { position: Vector3::zeros(), rate: Vector3::zeros(), acceleration: Vector3::zeros() }
    }
}

/// How the path is run through.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Profile {
    /// Constant rate of the path parameter, the paper's constant speed (section 6.1), with short
    /// blends at both ends.
    ConstantSpeed,
    /// One quintic time law, at rest at both ends.
    Quintic,
}

/// The internal reference: start -> via -> end.
///
/// The path is the parabola through the three waypoints, s(sigma) with sigma from 0 to 1 and via
/// where its share of the waypoints' distances lies; it is the straight line when they lie on one
/// evenly. Smooth in between: no corner at via, which is where the singularity is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference<T> {
    start: Vector3<T>,
    /// s = start + linear sigma + quadratic sigma^2
    linear: Vector3<T>,
    quadratic: Vector3<T>,
    move_time: T,
    profile: Profile,
}

/// Duration of a blend of the constant-speed profile by the move time.
const BLEND: f64 = 0.1;
/// Below this share of the path via coincides with start or end, and the path is straight.
const COINCIDENT: f64 = 1e-6;

impl Reference<f64> {
    /// The internal reference of a controller with `parameters`.
    pub fn of(parameters: &ControllerParameters) -> Self {
        let ControllerParameters { mechanism, waypoints, move_time, profile, .. } = parameters;
        let joint_radius = Geometry::new(mechanism.base_radius, mechanism.joint_spacing).joint_radius;
        Self::new(waypoints.map(Vector3::from), *move_time, *profile, joint_radius)
    }
}

impl<T: Scalar> Reference<T> {
    /// Through three waypoints (m, rad, rad) in `move_time` s. `joint_radius` r_b (m) makes angles
    /// commensurate with heave.
    pub fn new(waypoints: [Vector3<T>; 3], move_time: T, profile: Profile, joint_radius: T) -> Self {
        let [start, via, end] = waypoints;
        let distance = |a: Vector3<T>, b: Vector3<T>| {
            let d = b - a;
            (d.x * d.x + joint_radius * joint_radius * (d.y * d.y + d.z * d.z)).sqrt()
        };
        let (first, second) = (distance(start, via), distance(via, end));
        let whole = first + second;
        let coincident = whole * constant(COINCIDENT);
        let (linear, quadratic) = if first <= coincident || second <= coincident {
            (end - start, Vector3::zeros())
        } else {
            let share = first / whole;
            // Lagrange's interpolation at 0, share, 1
            let quadratic = ((via - start) / share - (end - start)) / (share - T::one());
            (end - start - quadratic, quadratic)
        };
        Self { start, linear, quadratic, move_time, profile }
    }

    /// The reference `t` s after the start; at rest at the start before it, at the end after it.
    pub fn at(&self, t: T) -> ReferencePoint<T> {
        let tau = t / self.move_time;
        let [sigma, rate, acceleration] = match self.profile {
            Profile::Quintic => quintic(tau),
            Profile::ConstantSpeed => constant_speed(tau),
        };
        let (rate, acceleration) = (rate / self.move_time, acceleration / (self.move_time * self.move_time));
        let tangent = self.linear + self.quadratic * (sigma + sigma);
        ReferencePoint {
            position: self.start + (self.linear + self.quadratic * sigma) * sigma,
            rate: tangent * rate,
            acceleration: tangent * acceleration + self.quadratic * (rate * rate + rate * rate),
        }
    }
}

/// sigma = 10 tau^3 - 15 tau^4 + 6 tau^5 and its derivatives with respect to tau.
fn quintic<T: Scalar>(tau: T) -> [T; 3] {
    let (zero, one) = (T::zero(), T::one());
    if tau <= zero {
        return [zero, zero, zero];
    }
    if tau >= one {
        return [one, zero, zero];
    }
    let c = |x: f64| constant::<T>(x);
    let square = tau * tau;
    [
        square * tau * (c(10.0) + tau * (c(-15.0) + tau * c(6.0))),
        square * (c(30.0) + tau * (c(-60.0) + tau * c(30.0))),
        tau * (c(60.0) + tau * (c(-180.0) + tau * c(120.0))),
    ]
}

/// Constant sigma_dot between blends with a cubic velocity profile.
fn constant_speed<T: Scalar>(tau: T) -> [T; 3] {
    let (zero, one) = (T::zero(), T::one());
    if tau <= zero {
        return [zero, zero, zero];
    }
    if tau >= one {
        return [one, zero, zero];
    }
    let blend = constant::<T>(BLEND);
    let speed = (one - blend).recip();
    // the blend from rest: rate = speed (3 r^2 - 2 r^3), r = t / blend, covers half of speed x blend
    let from_rest = |t: T| {
        let r = t / blend;
        let c = |x: f64| constant::<T>(x);
        [
            speed * blend * r * r * r * (one - r * c(0.5)),
            speed * r * r * (c(3.0) - c(2.0) * r),
            speed / blend * c(6.0) * r * (one - r),
        ]
    };
    if tau < blend {
        from_rest(tau)
    } else if tau > one - blend {
        let [sigma, rate, acceleration] = from_rest(one - tau);
        [one - sigma, rate, -acceleration]
    } else {
        [speed * (tau - blend * constant(0.5)), speed, zero]
    }
}

/// A reference from outside, extrapolated with constant acceleration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExternalReference<T>(pub ReferencePoint<T>);

impl<T: Scalar> ExternalReference<T> {
    /// The reference `ahead` s after the instant at which it was given.
    pub fn ahead(&self, ahead: T) -> ReferencePoint<T> {
        let ReferencePoint { position, rate, acceleration } = self.0;
        ReferencePoint {
            position: position + (rate + acceleration * (ahead * constant(0.5))) * ahead,
            rate: rate + acceleration * ahead,
            acceleration,
        }
    }
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;

    use super::*;

    fn reference<T: Scalar>(profile: Profile) -> Reference<T> {
        let waypoint = |x: [f64; 3]| Vector3::from(x).map(T::from);
        let waypoints = [waypoint([0.07, 0.1, 0.02]), waypoint([0.05, 0.12, 0.05]), waypoint([0.02, 0.1, 0.1])];
        Reference::new(waypoints, T::from(0.8), profile, T::from(0.2))
    }

    #[test]
    fn rates_are_the_derivatives_of_the_position() {
        for profile in [Profile::Quintic, Profile::ConstantSpeed] {
            for k in 0..100 {
                let t = 0.0081 * f64::from(k) - 0.002;
                let exact = reference::<f64>(profile).at(t);
                let dual = reference::<Dual64>(profile).at(Dual64::new(t, 1.0));
                assert!((dual.position.map(|x| x.eps) - exact.rate).amax() < 1e-14);
                assert!((dual.rate.map(|x| x.eps) - exact.acceleration).amax() < 1e-12);
            }
        }
    }

    #[test]
    fn a_reference_from_outside_goes_on_with_constant_acceleration() {
        let vector = |x: f64, y: f64, z: f64| Vector3::new(x, y, z).map(Dual64::from);
        let given = ReferencePoint {
            position: vector(0.07, 0.1, 0.02),
            rate: vector(0.3, -0.2, 0.5),
            acceleration: vector(-4.0, 3.0, 2.0),
        };
        assert_eq!(ExternalReference(given).ahead(Dual64::from(0.0)), given);
        for t in [0.0, 1e-3, 0.02] {
            let point = ExternalReference(given).ahead(Dual64::new(t, 1.0));
            assert!((point.position.map(|x| x.eps) - point.rate.map(|x| x.re)).amax() < 1e-15);
            assert_eq!(point.rate.map(|x| x.eps), given.acceleration.map(|x| x.re));
            assert_eq!(point.acceleration, given.acceleration);
        }
    }

    #[test]
    fn path_runs_through_all_waypoints_from_rest_to_rest() {
        for profile in [Profile::Quintic, Profile::ConstantSpeed] {
            let r = reference::<f64>(profile);
            for (t, expected) in [(0.0, [0.07, 0.1, 0.02]), (0.8, [0.02, 0.1, 0.1])] {
                assert!((r.at(t).position - Vector3::from(expected)).amax() < 1e-15);
                assert_eq!(r.at(t).rate, Vector3::zeros());
            }
            let via = Vector3::new(0.05, 0.12, 0.05);
            let closest = (0..=8000).map(|k| (r.at(1e-4 * f64::from(k)).position - via).norm()).fold(1.0, f64::min);
            assert!(closest < 1e-5, "{closest:e}");
        }
    }

    #[test]
    fn constant_speed_profile_keeps_its_speed_between_the_blends() {
        let straight = [[0.07, 0.1, 0.0], [0.05, 0.12, 0.0], [0.03, 0.14, 0.0]].map(Vector3::from);
        let r = Reference::<f64>::new(straight, 1.0, Profile::ConstantSpeed, 0.2);
        for k in 0..=80 {
            let point = r.at(0.1 + 0.01 * f64::from(k));
            assert!((point.rate - Vector3::new(-0.04, 0.04, 0.0) / 0.9).amax() < 1e-14);
        }
    }

    #[test]
    fn via_at_the_end_gives_a_straight_path() {
        let waypoints = [[0.07, 0.1, 0.0], [0.03, 0.14, 0.0], [0.03, 0.14, 0.0]].map(Vector3::from);
        let r = Reference::<f64>::new(waypoints, 1.0, Profile::Quintic, 0.2);
        assert!((r.at(0.5).position - Vector3::new(0.05, 0.12, 0.0)).amax() < 1e-15);
    }
}
