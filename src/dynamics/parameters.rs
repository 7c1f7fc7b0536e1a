//! Parameters of the mechanism and the plant, and what makes them possible.

use crate::defaults as d;

/// Geometry, masses, drives and motors. The controller's model of the plant has the same.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MechanismParameters {
    /// Radius a of the base joints' circle, m.
    pub base_radius: f64,
    /// Distance w between the spherical joints, m.
    pub joint_spacing: f64,
    /// Radius b of the plate, m; only feeds its default inertia.
    pub plate_radius: f64,
    /// Mass of the platform, kg.
    pub plate_mass: f64,
    /// Inertia of the platform about its in-plane axes through P, kg.m2; 0: uniform disc.
    pub plate_ixx: f64,
    /// Inertia of the platform about its normal, kg.m2; 0: uniform disc.
    pub plate_izz: f64,
    /// Mass of a lower link, kg.
    pub lower_mass: f64,
    /// Lower link's centre of mass from A, m.
    pub lower_com: f64,
    /// Lower link's inertia about its centre of mass, kg.m2.
    pub lower_inertia: f64,
    /// Mass of an upper link, kg.
    pub upper_mass: f64,
    /// Upper link's centre of mass from B, m.
    pub upper_com: f64,
    /// Upper link's inertia about its centre of mass, kg.m2.
    pub upper_inertia: f64,
    /// Lead of the leg's screw, m per revolution.
    pub screw_lead: f64,
    /// Gear ratio of the revolute drive, 1.
    pub gear_ratio: f64,
    /// Torque and back-emf constant, N.m/A.
    pub motor_kt: f64,
    /// Rotor inertia, kg.m2.
    pub motor_jm: f64,
    /// Viscous friction at the rotor, N.m.s/rad.
    pub motor_bm: f64,
    /// Armature inductance, H.
    pub motor_la: f64,
    /// Armature resistance, Ohm.
    pub motor_ra: f64,
    /// Gravitational acceleration along -z, m/s2.
    pub gravity: f64,
    /// Terminal voltage limit, V.
    pub v_max: f64,
    /// Six motors; else the three leg motors alone.
    pub revolute_motors: bool,
}

/// The plant's parameters.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PlantParameters {
    pub mechanism: MechanismParameters,
    /// End stops of the limb lengths, m.
    pub d_min: f64,
    pub d_max: f64,
    /// End stops of the limb angles, rad.
    pub theta_min: f64,
    pub theta_max: f64,
    /// Stiffness of the end stops, N/m (at a lever r_b for angles).
    pub stop_stiffness: f64,
    /// Damping of the end stops, N.s/m (at a lever r_b for angles).
    pub stop_damping: f64,
    /// Initial (heave in m, tilt_x, tilt_y in rad).
    pub start: [f64; 3],
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

impl MechanismParameters {
    /// Platform inertia about its in-plane axes and its normal, kg.m2.
    pub fn plate_inertia(&self) -> (f64, f64) {
        let disc = self.plate_mass * self.plate_radius * self.plate_radius;
        let or_disc = |given: f64, disc: f64| if given > 0.0 { given } else { disc };
        (or_disc(self.plate_ixx, 0.25 * disc), or_disc(self.plate_izz, 0.5 * disc))
    }

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
    /// limits is for [`super::PlantModel::start`] to say.
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
