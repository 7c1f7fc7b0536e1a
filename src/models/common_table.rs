//! Variables that both FMUs have: the mechanism's parameters, and helpers of the tables.

use crate::defaults as d;
use crate::description::Variable;

/// Inclusive lower limit for what must be positive.
pub const POSITIVE: f64 = 1e-9;
const INF: f64 = f64::INFINITY;

/// `prefix1`, `prefix2`, `prefix3`, each followed by `suffix`.
pub fn per_limb(prefix: &str, suffix: &str) -> [String; 3] {
    [1, 2, 3].map(|i| format!("{prefix}{i}{suffix}"))
}

/// The three generalized coordinates with a suffix.
pub fn coordinates(suffix: &str) -> [String; 3] {
    ["heave", "tilt_x", "tilt_y"].map(|name| format!("{name}{suffix}"))
}

/// Names of a list of variables.
pub fn names(variables: &[Variable]) -> Vec<String> {
    variables.iter().map(|v| v.name.clone()).collect()
}

/// Units (SI, display) of heave, tilt_x, tilt_y.
pub const COORDINATE_UNITS: [(&str, &str); 3] = [("m", "cm"), ("rad", "deg"), ("rad", "deg")];
/// Units of their rates.
pub const RATE_UNITS: [(&str, &str); 3] = [("m/s", "cm/s"), ("rad/s", "deg/s"), ("rad/s", "deg/s")];

/// Geometry, masses, drives and motors: value references 1000 to 1049, Boolean 1000.
pub fn mechanism_parameters() -> Vec<Variable> {
    let real = |vr, name: &str, unit, start, min, max, text: &str| {
        Variable::real(name, vr, unit, text).parameter().start(start).range(min, max)
    };
    vec![
        real(1000, "base_radius", Some("m"), d::BASE_RADIUS, POSITIVE, INF, "Radius a of the base joints' circle")
            .display("cm"),
        real(1001, "joint_spacing", Some("m"), d::JOINT_SPACING, POSITIVE, INF, "Distance w between spherical joints")
            .display("cm"),
        real(1002, "plate_radius", Some("m"), d::PLATE_RADIUS, POSITIVE, INF, "Radius b of the plate (inertia only)")
            .display("cm"),
        real(1003, "plate_mass", Some("kg"), d::PLATE_MASS, POSITIVE, INF, "Mass of the platform"),
        real(1004, "plate_ixx", Some("kg.m2"), 0.0, 0.0, INF, "Platform inertia about x and y; 0: uniform disc"),
        real(1005, "plate_izz", Some("kg.m2"), 0.0, 0.0, INF, "Platform inertia about its normal; 0: uniform disc"),
        real(1006, "lower_mass", Some("kg"), d::LOWER_MASS, 0.0, INF, "Mass of a lower link"),
        real(1007, "lower_com", Some("m"), d::LOWER_COM, -INF, INF, "Lower link's centre of mass from A").display("cm"),
        real(1008, "lower_inertia", Some("kg.m2"), d::LOWER_INERTIA, 0.0, INF, "Lower link's inertia about its centre"),
        real(1009, "upper_mass", Some("kg"), d::UPPER_MASS, 0.0, INF, "Mass of an upper link"),
        real(1010, "upper_com", Some("m"), d::UPPER_COM, -INF, INF, "Upper link's centre of mass from B").display("cm"),
        real(1011, "upper_inertia", Some("kg.m2"), d::UPPER_INERTIA, 0.0, INF, "Upper link's inertia about its centre"),
        real(1012, "screw_lead", Some("m"), d::SCREW_LEAD, POSITIVE, INF, "Lead of the leg's screw per revolution")
            .display("mm"),
        real(1013, "gear_ratio", None, d::GEAR_RATIO, POSITIVE, INF, "Gear ratio of the revolute drive"),
        real(1014, "motor_kt", Some("N.m/A"), d::MOTOR_KT, POSITIVE, INF, "Torque and back-emf constant"),
        real(1015, "motor_jm", Some("kg.m2"), d::MOTOR_JM, 0.0, INF, "Rotor inertia"),
        real(1016, "motor_bm", Some("N.m.s/rad"), d::MOTOR_BM, 0.0, INF, "Viscous friction at the rotor"),
        real(1017, "motor_la", Some("H"), d::MOTOR_LA, POSITIVE, INF, "Armature inductance").nominal(1e-3),
        real(1018, "motor_ra", Some("Ohm"), d::MOTOR_RA, POSITIVE, INF, "Armature resistance"),
        real(1019, "gravity", Some("m/s2"), d::GRAVITY, -INF, INF, "Gravitational acceleration along -z"),
        real(1020, "v_max", Some("V"), d::V_MAX, POSITIVE, INF, "Terminal voltage limit, both signs"),
        Variable::boolean(
            "revolute_motors",
            1000,
            "Revolute motors powered too (six motors); if not, their circuits are open and their rotors turn along",
        )
        .parameter()
        .start_boolean(true),
    ]
}
