//! Every default value, once: the core's `Default` implementations and the start values of both
//! model descriptions come from here. SI units. Values marked * are printed in the paper, the
//! others are assumptions (see docs/theory.md).
#![forbid(unsafe_code)]

/// Base circle radius a, m *
pub const BASE_RADIUS: f64 = 0.4172;
/// Distance w between the spherical joints, m *
pub const JOINT_SPACING: f64 = 0.3616;
/// Radius b of the platform's plate, m *
pub const PLATE_RADIUS: f64 = 0.2208;

/// Plate mass, kg
pub const PLATE_MASS: f64 = 4.0;
/// Lower link: mass, kg; centre of mass from A, m; inertia about it, kg.m2
pub const LOWER_MASS: f64 = 0.6;
pub const LOWER_COM: f64 = 0.08;
pub const LOWER_INERTIA: f64 = 2e-3;
/// Upper link: mass, kg; centre of mass from B, m; inertia about it, kg.m2
pub const UPPER_MASS: f64 = 0.3;
pub const UPPER_COM: f64 = 0.10;
pub const UPPER_INERTIA: f64 = 1e-3;

/// Screw lead, m per revolution
pub const SCREW_LEAD: f64 = 0.010;
/// Gear ratio of the revolute drive
pub const GEAR_RATIO: f64 = 50.0;
/// Torque constant (= back-emf constant), N.m/A *
pub const MOTOR_KT: f64 = 0.21;
/// Rotor inertia, kg.m2 *
pub const MOTOR_JM: f64 = 3.7e-5;
/// Viscous friction, N.m.s/rad *
pub const MOTOR_BM: f64 = 1.3e-5;
/// Armature inductance, H *
pub const MOTOR_LA: f64 = 2.4e-3;
/// Armature resistance, Ohm *
pub const MOTOR_RA: f64 = 4.8;
/// Terminal voltage limit, V
pub const V_MAX: f64 = 48.0;
/// Gravitational acceleration, m/s2
pub const GRAVITY: f64 = 9.81;

/// Home pose: heave 5 cm without tilt gives limb length 21.434 cm and limb angle 13.490 deg;
/// the limits are +-10 cm * and +-20 deg * about it.
pub const D_MIN: f64 = 0.1143;
pub const D_MAX: f64 = 0.3143;
pub const THETA_MIN: f64 = -6.51 * DEG;
pub const THETA_MAX: f64 = 33.49 * DEG;
/// End stops: stiffness, N/m, and damping, N.s/m
pub const STOP_STIFFNESS: f64 = 1e6;
pub const STOP_DAMPING: f64 = 5e3;

/// The default crossing passes this singular pose (tilt 8 deg, direction 40 deg) ...
pub const VIA_HEAVE: f64 = 0.0452873763;
pub const VIA_TILT_X: f64 = 8.0 * DEG * COS_40;
pub const VIA_TILT_Y: f64 = 8.0 * DEG * SIN_40;
/// ... from a start that differs by this heave, m, and share of the tilt, to the end on the opposite side
pub const CROSSING_HEAVE: f64 = 0.025;
pub const CROSSING_TILT: f64 = -0.3;
/// Start and end
pub const START_HEAVE: f64 = VIA_HEAVE + CROSSING_HEAVE;
pub const START_TILT_X: f64 = (1.0 + CROSSING_TILT) * VIA_TILT_X;
pub const START_TILT_Y: f64 = (1.0 + CROSSING_TILT) * VIA_TILT_Y;
pub const END_HEAVE: f64 = VIA_HEAVE - CROSSING_HEAVE;
pub const END_TILT_X: f64 = (1.0 - CROSSING_TILT) * VIA_TILT_X;
pub const END_TILT_Y: f64 = (1.0 - CROSSING_TILT) * VIA_TILT_Y;
/// Limb lengths, m, and angles, rad, at the start of the default crossing
pub const START_MEASUREMENTS: [f64; 6] = [0.216447998, 0.228487031, 0.217582323, 0.267406495, 0.406534128, 0.295287088];
/// Duration of the crossing, s
pub const MOVE_TIME: f64 = 1.0;

/// Controller sample time, s
pub const SAMPLE_TIME: f64 = 1e-3;
/// Feedback gains, 1/s2 and 1/s
pub const K_P: f64 = 900.0;
pub const K_D: f64 = 60.0;
pub const K_A: f64 = 0.0;
/// Fixed damping factors (modes 2 and 3)
pub const RHO_FIXED: f64 = 0.05;
pub const DELTA_HD_FIXED: f64 = 0.1;
pub const LAMBDA_F_FIXED: f64 = 5e-3;

/// Time constant of the pose estimate's filter, s
pub const FILTER_TIME: f64 = 0.05;
/// Swarm
pub const SWARM_SIZE: i32 = 20;
pub const MAX_ITERATIONS: i32 = 30;
pub const STALL_ITERATIONS: i32 = 12;
pub const C1: f64 = 2.0;
pub const C2: f64 = 2.0;
/// Inertia from .. to (3.2) *, decay scale from .. to (3.5) *, regulating scale R (3.5) *
pub const INERTIA_MAX: f64 = 0.9;
pub const INERTIA_MIN: f64 = 0.4;
pub const DECAY_MAX: f64 = 0.7;
pub const DECAY_MIN: f64 = 0.005;
pub const REGULATING_SCALE: f64 = 1.25;
/// Largest step of a particle, as a fraction of the search range
pub const VELOCITY_LIMIT: f64 = 0.2;
pub const SEED: i32 = 1;
/// Search ranges, from 0
pub const RHO_MAX: f64 = 1.0;
pub const DELTA_HD_MAX: f64 = 0.1;
pub const LAMBDA_F_MAX: f64 = 0.3;
/// Fitness: prediction horizon, s; weights of velocity error, s2, and acceleration, s4
pub const HORIZON: f64 = 0.02;
pub const WEIGHT_VELOCITY: f64 = 1e-4;
pub const WEIGHT_ACCELERATION: f64 = 1e-8;

/// Table 1 *: resolution, repeatability and static accuracy of lengths (m) and angles (rad)
pub const SENSOR_LENGTH_RESOLUTION: f64 = 1e-4;
pub const SENSOR_LENGTH_NOISE: f64 = 1.5e-4;
pub const SENSOR_LENGTH_BIAS: f64 = 3e-3;
pub const SENSOR_ANGLE_RESOLUTION: f64 = 0.15 * DEG;
pub const SENSOR_ANGLE_NOISE: f64 = 0.2 * DEG;
/// Time without a valid measurement after which the voltages are zero, s
pub const SENSOR_TIMEOUT: f64 = 0.02;

/// Default experiment of both FMUs, s
pub const STOP_TIME: f64 = 1.4;
pub const STEP_SIZE: f64 = 1e-3;
pub const TOLERANCE: f64 = 1e-6;

/// One degree, rad
pub const DEG: f64 = std::f64::consts::PI / 180.0;
const COS_40: f64 = 0.766_044_443_118_978;
const SIN_40: f64 = 0.642_787_609_686_539_3;
