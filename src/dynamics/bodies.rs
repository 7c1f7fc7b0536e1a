//! Platform and links: mass matrix and velocity-, gravity-dependent forces.

use nalgebra::{Matrix3, Vector3};

use super::{MechanismParameters, Motors};
use crate::mechanism::{Limb, LimbMotion, Pose, PoseMotion};
use crate::scalar::{Scalar, constant};

/// Masses and inertias.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bodies<T> {
    /// Platform mass, kg.
    pub plate_mass: T,
    /// Platform inertia about its in-plane axes, kg.m2.
    pub plate_ixx: T,
    /// Platform inertia about its normal, kg.m2.
    pub plate_izz: T,
    /// First moment of a lower link about A, kg.m.
    lower_moment: T,
    /// Inertia of a limb about A but for the upper link's m (d - c_u)^2, kg.m2.
    limb_inertia: T,
    /// Upper link's mass, kg.
    pub upper_mass: T,
    /// Upper link's centre of mass from B, m.
    upper_com: T,
    /// Gravitational acceleration, m/s2.
    pub gravity: T,
}

/// The equation of motion M s_ddot + h = Q, and the limbs' own equations it is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MechanismDynamics<T> {
    /// M(s): kg, kg.m, kg.m2.
    pub mass_matrix: Matrix3<T>,
    /// h(s, s_dot): Coriolis, centrifugal and gravity forces, (N, N.m, N.m).
    pub bias: Vector3<T>,
}

impl<T: Scalar> Bodies<T> {
    pub(super) fn new(p: &MechanismParameters<T>) -> Self {
        let (ixx, izz) = p.plate_inertia();
        Self {
            plate_mass: p.plate_mass,
            plate_ixx: ixx,
            plate_izz: izz,
            lower_moment: p.lower_mass * p.lower_com,
            limb_inertia: p.lower_inertia + p.lower_mass * p.lower_com * p.lower_com + p.upper_inertia,
            upper_mass: p.upper_mass,
            upper_com: p.upper_com,
            gravity: p.gravity,
        }
    }

    /// Platform inertia times `v`, base frame: I v = I_xx v + (I_zz - I_xx) z_p (z_p . v).
    #[inline]
    pub fn plate_inertia_times(&self, pose: &Pose<T>, v: &Vector3<T>) -> Vector3<T> {
        let normal = pose.rotation.column(2);
        v * self.plate_ixx + normal * ((self.plate_izz - self.plate_ixx) * normal.dot(v))
    }

    /// Inertia of a limb about its revolute joint without its drive, kg.m2.
    #[inline]
    pub fn limb_inertia(&self, limb: &Limb<T>) -> T {
        let upper_arm = limb.length - self.upper_com;
        self.limb_inertia + self.upper_mass * upper_arm * upper_arm
    }

    /// Generalized forces (N along the limb, N.m about A) that a limb without its drive's inertia
    /// needs at zero length and angle acceleration: centrifugal, Coriolis, gravity.
    #[inline]
    pub fn limb_bias(&self, limb: &Limb<T>, motion: &LimbMotion<T>) -> (T, T) {
        let upper_moment = self.upper_mass * (limb.length - self.upper_com);
        let omega = motion.angle_rate;
        let along = self.gravity * self.upper_mass * limb.sin - upper_moment * omega * omega;
        let about = self.gravity * limb.cos * (self.lower_moment + upper_moment)
            + constant::<T>(2.0) * upper_moment * motion.length_rate * omega;
        (along, about)
    }

    /// The wrench (N; N.m about P) that the platform needs at accelerations of P and about it,
    /// gravity included: Newton and Euler (6.7)-(6.9).
    #[inline]
    pub fn plate_wrench(
        &self,
        pose: &Pose<T>,
        angular_velocity: &Vector3<T>,
        linear: &Vector3<T>,
        angular: &Vector3<T>,
    ) -> (Vector3<T>, Vector3<T>) {
        let mut force = linear * self.plate_mass;
        force.z += self.plate_mass * self.gravity;
        let momentum = self.plate_inertia_times(pose, angular_velocity);
        (force, self.plate_inertia_times(pose, angular) + angular_velocity.cross(&momentum))
    }

    /// Mass matrix alone, reflected rotor inertia included.
    #[inline]
    pub fn mass_matrix(&self, pose: &Pose<T>, limbs: &[Limb<T>; 3], motors: &Motors<T>) -> Matrix3<T> {
        let mut m = Matrix3::zeros();
        // The platform, row by row of the maps: the components of P's and the angular velocity.
        // Heave moves P along z alone, tilt does not.
        m.m11 = self.plate_mass;
        for row in 0..2 {
            let gradient = Vector3::new(T::zero(), pose.linear_map[(row, 1)], pose.linear_map[(row, 2)]);
            add_outer(&mut m, &gradient, self.plate_mass);
        }
        for row in 0..3 {
            let gradient = Vector3::new(T::zero(), pose.angular_map[(row, 1)], pose.angular_map[(row, 2)]);
            add_outer(&mut m, &gradient, self.plate_ixx);
        }
        let normal_rate = pose.generalized_force(&Vector3::zeros(), &pose.rotation.column(2).into());
        add_outer(&mut m, &normal_rate, self.plate_izz - self.plate_ixx);
        for limb in limbs {
            add_outer(&mut m, &limb.length_gradient, self.upper_mass + motors.leg.reflected_inertia);
            add_outer(&mut m, &limb.angle_gradient, self.limb_inertia(limb) + motors.revolute.reflected_inertia);
        }
        (m.m12, m.m13, m.m23) = (m.m21, m.m31, m.m32);
        m
    }

    /// M and h by projecting every body's Newton-Euler equations onto the coordinates.
    #[inline]
    pub fn dynamics(
        &self,
        pose: &Pose<T>,
        motion: &PoseMotion<T>,
        limbs: &[Limb<T>; 3],
        limb_motions: &[LimbMotion<T>; 3],
        motors: &Motors<T>,
    ) -> MechanismDynamics<T> {
        let (force, moment) =
            self.plate_wrench(pose, &motion.angular_velocity, &motion.linear_bias, &motion.angular_bias);
        let mut bias = pose.generalized_force(&force, &moment);
        for (limb, rates) in limbs.iter().zip(limb_motions) {
            let (along, about) = self.limb_bias(limb, rates);
            let length_inertia = self.upper_mass + motors.leg.reflected_inertia;
            let angle_inertia = self.limb_inertia(limb) + motors.revolute.reflected_inertia;
            bias += limb.length_gradient * (along + length_inertia * rates.length_bias);
            bias += limb.angle_gradient * (about + angle_inertia * rates.angle_bias);
        }
        MechanismDynamics { mass_matrix: self.mass_matrix(pose, limbs, motors), bias }
    }

    /// Potential energy, J; zero at height zero.
    pub fn potential_energy(&self, pose: &Pose<T>, limbs: &[Limb<T>; 3]) -> T {
        let mut energy = self.plate_mass * pose.position.z;
        for limb in limbs {
            energy += limb.sin * (self.lower_moment + self.upper_mass * (limb.length - self.upper_com));
        }
        energy * self.gravity
    }
}

/// m += scale v v^T in the lower triangle.
#[inline]
fn add_outer<T: Scalar>(m: &mut Matrix3<T>, v: &Vector3<T>, scale: T) {
    let scaled = v * scale;
    for j in 0..3 {
        for i in j..3 {
            m[(i, j)] += scaled[i] * v[j];
        }
    }
}
