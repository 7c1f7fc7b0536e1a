//! The cubic F(d_ave) (2.11), Appendix C: at a given direction of the platform, the heaves at
//! which the mechanism is singular.

use nalgebra::Vector3;

use super::super::{Geometry, Pose};
use super::RealRoots;
use crate::scalar::{Scalar, constant};

/// F(d_ave) = Omega_1 d_ave^3 + Omega_2 d_ave^2 + Omega_3 d_ave + Omega_4 = det(A) / 8, lengths
/// divided by the base radius a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SingularityCubic<T> {
    /// Omega_1 .. Omega_4, dimensionless.
    pub omega: [T; 4],
}

impl<T: Scalar> SingularityCubic<T> {
    /// (C.1), with the Omega_4 that det A has in place of the printed one (docs/errata.md).
    ///
    /// `e`: distances of the spherical joints' projections from the centre of the base (2.7);
    /// `h`: differences of the joints' heights (2.8), of sum zero. Both divided by a.
    pub fn new(e: [T; 3], h: [T; 3]) -> Self {
        let [e1, e2, e3] = e;
        let [h1, h2, h3] = h;
        let (one, two, four) = (T::one(), constant::<T>(2.0), constant::<T>(4.0));
        let quarter = constant::<T>(0.25);
        let three_quarters = constant::<T>(0.75);
        let square = |x: T| x * x;
        // x^2 + x, and x^2 + x - 2 = (x - 1)(x + 2), which recurs in Omega_3 and Omega_4
        let p = |x: T| square(x) + x;
        let q = |x: T| (x - one) * (x + two);
        let g = e1 * (e2 * e3 - e2 - e3 + four) + e2 * (e1 * e3 - e1 - e3 + four) + e3 * (e1 * e2 - e1 - e2 + four);

        let omega_1 = -three_quarters
            * (constant::<T>(3.0) * e1 * e2 * e3
                + e1 * (square(e2) + square(e3))
                + e2 * (square(e1) + square(e3))
                + e3 * (square(e1) + square(e2)));
        let omega_2 =
            three_quarters * (e1 * h1 * (p(e3) - p(e2)) + e2 * h2 * (p(e1) - p(e3)) + e3 * h3 * (p(e2) - p(e1)));
        let omega_3 = quarter
            * (-(h1 * h2 + h2 * h3 + h3 * h1) * g
                + h1 * (h3 - h2) * (e3 * q(e2) - e2 * q(e3))
                + h2 * (h1 - h3) * (e1 * q(e3) - e3 * q(e1))
                + h3 * (h2 - h1) * (e2 * q(e1) - e1 * q(e2)));
        let (g1, g2, g3) = (h2 - h3, h3 - h1, h1 - h2);
        let omega_4 = -constant::<T>(1.0 / 36.0)
            * (g1 * g2 * g3 * g
                + square(g1) * (g2 * e2 * q(e3) + g3 * e3 * q(e2))
                + square(g2) * (g1 * e1 * q(e3) + g3 * e3 * q(e1))
                + square(g3) * (g1 * e1 * q(e2) + g2 * e2 * q(e1)));
        Self { omega: [omega_1, omega_2, omega_3, omega_4] }
    }

    /// At a tilt of the platform (rad). Heave moves all joints alike and P's horizontal position
    /// follows from the tilt, so `e` and `h` are functions of the tilt alone.
    pub fn at_tilt(geometry: &Geometry<T>, tilt_x: T, tilt_y: T) -> Self {
        let pose = Pose::new(geometry, &Vector3::new(T::zero(), tilt_x, tilt_y));
        let joint = |i: usize| {
            let joint = pose.position + pose.rotation * geometry.radial[i] * geometry.joint_radius;
            (joint.dot(&geometry.radial[i]) / geometry.base_radius, joint.z / geometry.base_radius)
        };
        let [(e1, z1), (e2, z2), (e3, z3)] = [0, 1, 2].map(joint);
        Self::new([e1, e2, e3], [z3 - z2, z1 - z3, z2 - z1])
    }

    /// F at `d_ave`, the heave over a.
    pub fn value(&self, d_ave: T) -> T {
        self.omega.iter().fold(T::zero(), |sum, &coefficient| sum * d_ave + coefficient)
    }
}

/// All heaves (m) at which the platform of the given tilt (rad) is in a direct singularity; one to
/// three, ascending.
///
/// Without tilt heave 0 is a threefold root: all three limbs lie in the platform's plane.
pub fn singular_heights(geometry: &Geometry<f64>, tilt_x: f64, tilt_y: f64) -> RealRoots {
    let cubic = SingularityCubic::at_tilt(geometry, tilt_x, tilt_y);
    RealRoots::of_cubic(cubic.omega).scaled(geometry.base_radius)
}
