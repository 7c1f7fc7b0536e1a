//! Parameters of the mechanism and the plant, and what makes them possible.

use crate::defaults as d;
use crate::scalar::{Scalar, constant};

/// Geometry, masses, drives and motors. The controller's model of the plant has the same.
///
/// Generic like the model equations, so that derivatives with respect to parameters exist as well.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MechanismParameters<T = f64> {
    /// Radius a of the base joints' circle, m.
    pub base_radius: T,
    /// Distance w between the spherical joints, m.
    pub joint_spacing: T,
    /// Radius b of the plate, m; only feeds its default inertia.
    pub plate_radius: T,
    /// Mass of the platform, kg.
    pub plate_mass: T,
    /// Inertia of the platform about its in-plane axes through P, kg.m2; 0: uniform disc.
    pub plate_ixx: T,
    /// Inertia of the platform about its normal, kg.m2; 0: uniform disc.
    pub plate_izz: T,
    /// Mass of a lower link, kg.
    pub lower_mass: T,
    /// Lower link's centre of mass from A, m.
    pub lower_com: T,
    /// Lower link's inertia about its centre of mass, kg.m2.
    pub lower_inertia: T,
    /// Mass of an upper link, kg.
    pub upper_mass: T,
    /// Upper link's centre of mass from B, m.
    pub upper_com: T,
    /// Upper link's inertia about its centre of mass, kg.m2.
    pub upper_inertia: T,
    /// Lead of the leg's screw, m per revolution.
    pub screw_lead: T,
    /// Gear ratio of the revolute drive, 1.
    pub gear_ratio: T,
    /// Torque and back-emf constant, N.m/A.
    pub motor_kt: T,
    /// Rotor inertia, kg.m2.
    pub motor_jm: T,
    /// Viscous friction at the rotor, N.m.s/rad.
    pub motor_bm: T,
    /// Armature inductance, H.
    pub motor_la: T,
    /// Armature resistance, Ohm.
    pub motor_ra: T,
    /// Gravitational acceleration along -z, m/s2.
    pub gravity: T,
    /// Terminal voltage limit, V.
    pub v_max: T,
    /// Six motors; else the leg motors alone, the revolute motors' circuits being open.
    pub revolute_motors: bool,
}

/// The plant's parameters.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PlantParameters<T = f64> {
    pub mechanism: MechanismParameters<T>,
    /// End stops of the limb lengths, m.
    pub d_min: T,
    pub d_max: T,
    /// End stops of the limb angles, rad.
    pub theta_min: T,
    pub theta_max: T,
    /// Stiffness of the end stops, N/m (at a lever r_b for angles).
    pub stop_stiffness: T,
    /// Damping of the end stops, N.s/m (at a lever r_b for angles).
    pub stop_damping: T,
    /// Initial (heave in m, tilt_x, tilt_y in rad).
    pub start: [T; 3],
    /// Initial currents hold the initial pose.
    pub settled_start: bool,
}

impl Default for MechanismParameters {
    fn default() -> Self {
        Self {
            base_radius: d::BASE_RADIUS,
            joint_spacing: d::JOINT_SPACING,
            plate_radius: d::PLATE_RADIUS,
            plate_mass: d::PLATE_MASS,
            plate_ixx: 0.0,
            plate_izz: 0.0,
            lower_mass: d::LOWER_MASS,
            lower_com: d::LOWER_COM,
            lower_inertia: d::LOWER_INERTIA,
            upper_mass: d::UPPER_MASS,
            upper_com: d::UPPER_COM,
            upper_inertia: d::UPPER_INERTIA,
            screw_lead: d::SCREW_LEAD,
            gear_ratio: d::GEAR_RATIO,
            motor_kt: d::MOTOR_KT,
            motor_jm: d::MOTOR_JM,
            motor_bm: d::MOTOR_BM,
            motor_la: d::MOTOR_LA,
            motor_ra: d::MOTOR_RA,
            gravity: d::GRAVITY,
            v_max: d::V_MAX,
            revolute_motors: true,
        }
    }
}

impl Default for PlantParameters {
    fn default() -> Self {
        Self {
            mechanism: MechanismParameters::default(),
            d_min: d::D_MIN,
            d_max: d::D_MAX,
            theta_min: d::THETA_MIN,
            theta_max: d::THETA_MAX,
            stop_stiffness: d::STOP_STIFFNESS,
            stop_damping: d::STOP_DAMPING,
            start: [d::START_HEAVE, d::START_TILT_X, d::START_TILT_Y],
            settled_start: true,
        }
    }
}

/// Why parameters describe no possible mechanism or start.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ParameterError {
    #[error("{name} = {value} is not finite")]
    NotFinite { name: &'static str, value: f64 },
    #[error("{name} = {value} must be positive")]
    NotPositive { name: &'static str, value: f64 },
    #[error("{name} = {value} must not be negative")]
    Negative { name: &'static str, value: f64 },
    #[error("{min} = {min_value} must be below {max} = {max_value}")]
    EmptyRange { min: &'static str, min_value: f64, max: &'static str, max_value: f64 },
    #[error("d_min = {0} m must leave the limbs a positive length of at least 1 mm")]
    LimbCanVanish(f64),
    #[error("plate_ixx = {ixx} and plate_izz = {izz} kg.m2 are no rigid body's: plate_izz must not exceed 2 plate_ixx")]
    ImpossibleInertia { ixx: f64, izz: f64 },
    #[error("the start pose heave = {} m, tilt = ({}, {}) rad puts {quantity} {limb} = {value} outside its limits [{min}, {max}]", pose[0], pose[1], pose[2])]
    StartBeyondLimits { pose: [f64; 3], quantity: &'static str, limb: usize, value: f64, min: f64, max: f64 },
    #[error("the start pose's tilt {0} rad is 90 deg or more")]
    TiltTooLarge(f64),
    #[error("the mass matrix at the start pose is not positive definite")]
    SingularMassMatrix,
}

/// All of `checks` must be finite, and positive or not negative as said.
pub(crate) fn check(
    positive: &[(&'static str, f64)],
    not_negative: &[(&'static str, f64)],
    finite: &[(&'static str, f64)],
) -> Result<(), ParameterError> {
    for &(name, value) in positive.iter().chain(not_negative).chain(finite) {
        if !value.is_finite() {
            return Err(ParameterError::NotFinite { name, value });
        }
    }
    if let Some(&(name, value)) = positive.iter().find(|(_, value)| *value <= 0.0) {
        return Err(ParameterError::NotPositive { name, value });
    }
    if let Some(&(name, value)) = not_negative.iter().find(|(_, value)| *value < 0.0) {
        return Err(ParameterError::Negative { name, value });
    }
    Ok(())
}

impl<T: Scalar> MechanismParameters<T> {
    /// From a function that tells each parameter's value by its name.
    pub fn by_name(value: impl Fn(&'static str) -> T, revolute_motors: bool) -> Self {
        Self {
            base_radius: value("base_radius"),
            joint_spacing: value("joint_spacing"),
            plate_radius: value("plate_radius"),
            plate_mass: value("plate_mass"),
            plate_ixx: value("plate_ixx"),
            plate_izz: value("plate_izz"),
            lower_mass: value("lower_mass"),
            lower_com: value("lower_com"),
            lower_inertia: value("lower_inertia"),
            upper_mass: value("upper_mass"),
            upper_com: value("upper_com"),
            upper_inertia: value("upper_inertia"),
            screw_lead: value("screw_lead"),
            gear_ratio: value("gear_ratio"),
            motor_kt: value("motor_kt"),
            motor_jm: value("motor_jm"),
            motor_bm: value("motor_bm"),
            motor_la: value("motor_la"),
            motor_ra: value("motor_ra"),
            gravity: value("gravity"),
            v_max: value("v_max"),
            revolute_motors,
        }
    }

    /// With every number replaced, for instance by a dual number of the same value.
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> MechanismParameters<U> {
        MechanismParameters {
            base_radius: f(self.base_radius),
            joint_spacing: f(self.joint_spacing),
            plate_radius: f(self.plate_radius),
            plate_mass: f(self.plate_mass),
            plate_ixx: f(self.plate_ixx),
            plate_izz: f(self.plate_izz),
            lower_mass: f(self.lower_mass),
            lower_com: f(self.lower_com),
            lower_inertia: f(self.lower_inertia),
            upper_mass: f(self.upper_mass),
            upper_com: f(self.upper_com),
            upper_inertia: f(self.upper_inertia),
            screw_lead: f(self.screw_lead),
            gear_ratio: f(self.gear_ratio),
            motor_kt: f(self.motor_kt),
            motor_jm: f(self.motor_jm),
            motor_bm: f(self.motor_bm),
            motor_la: f(self.motor_la),
            motor_ra: f(self.motor_ra),
            gravity: f(self.gravity),
            v_max: f(self.v_max),
            revolute_motors: self.revolute_motors,
        }
    }

    /// Platform inertia about its in-plane axes and its normal, kg.m2.
    pub fn plate_inertia(&self) -> (T, T) {
        let disc = self.plate_mass * self.plate_radius * self.plate_radius;
        let or_disc = |given: T, factor: f64| if given > T::zero() { given } else { disc * constant(factor) };
        (or_disc(self.plate_ixx, 0.25), or_disc(self.plate_izz, 0.5))
    }
}

impl<T: Scalar> PlantParameters<T> {
    /// From a function that tells each parameter's value by its name.
    pub fn by_name(value: impl Fn(&'static str) -> T, revolute_motors: bool, settled_start: bool) -> Self {
        Self {
            d_min: value("d_min"),
            d_max: value("d_max"),
            theta_min: value("theta_min"),
            theta_max: value("theta_max"),
            stop_stiffness: value("stop_stiffness"),
            stop_damping: value("stop_damping"),
            start: [value("heave_start"), value("tilt_x_start"), value("tilt_y_start")],
            settled_start,
            mechanism: MechanismParameters::by_name(value, revolute_motors),
        }
    }

    /// With every number replaced, for instance by a dual number of the same value.
    pub fn map<U>(&self, f: impl Fn(T) -> U) -> PlantParameters<U> {
        PlantParameters {
            d_min: f(self.d_min),
            d_max: f(self.d_max),
            theta_min: f(self.theta_min),
            theta_max: f(self.theta_max),
            stop_stiffness: f(self.stop_stiffness),
            stop_damping: f(self.stop_damping),
            start: self.start.map(&f),
            settled_start: self.settled_start,
            mechanism: self.mechanism.map(f),
        }
    }
}

impl MechanismParameters {
    /// # Errors
    /// Names the first parameter that no mechanism can have.
    pub fn validate(&self) -> Result<(), ParameterError> {
        check(
            &[
                ("base_radius", self.base_radius),
                ("joint_spacing", self.joint_spacing),
                ("plate_radius", self.plate_radius),
                ("plate_mass", self.plate_mass),
                ("screw_lead", self.screw_lead),
                ("gear_ratio", self.gear_ratio),
                ("motor_kt", self.motor_kt),
                ("motor_la", self.motor_la),
                ("motor_ra", self.motor_ra),
                ("v_max", self.v_max),
            ],
            &[
                ("plate_ixx", self.plate_ixx),
                ("plate_izz", self.plate_izz),
                ("lower_mass", self.lower_mass),
                ("lower_inertia", self.lower_inertia),
                ("upper_mass", self.upper_mass),
                ("upper_inertia", self.upper_inertia),
                ("motor_jm", self.motor_jm),
                ("motor_bm", self.motor_bm),
            ],
            &[("lower_com", self.lower_com), ("upper_com", self.upper_com), ("gravity", self.gravity)],
        )?;
        let (ixx, izz) = self.plate_inertia();
        // the triangle inequality of principal moments; the disc itself meets it with equality
        if izz > 2.0 * ixx * (1.0 + 1e-12) {
            return Err(ParameterError::ImpossibleInertia { ixx, izz });
        }
        Ok(())
    }
}

impl PlantParameters {
    /// # Errors
    /// Names the first parameter that no plant can have. Whether the start pose lies within the
    /// limits is for the model to say, which knows the geometry.
    pub fn validate(&self) -> Result<(), ParameterError> {
        self.mechanism.validate()?;
        check(
            &[],
            &[("stop_stiffness", self.stop_stiffness), ("stop_damping", self.stop_damping)],
            &[
                ("d_min", self.d_min),
                ("d_max", self.d_max),
                ("theta_min", self.theta_min),
                ("theta_max", self.theta_max),
                ("heave_start", self.start[0]),
                ("tilt_x_start", self.start[1]),
                ("tilt_y_start", self.start[2]),
            ],
        )?;
        for (min, min_value, max, max_value) in
            [("d_min", self.d_min, "d_max", self.d_max), ("theta_min", self.theta_min, "theta_max", self.theta_max)]
        {
            if min_value >= max_value {
                return Err(ParameterError::EmptyRange { min, min_value, max, max_value });
            }
        }
        if self.d_min < 1e-3 {
            return Err(ParameterError::LimbCanVanish(self.d_min));
        }
        Ok(())
    }
}
