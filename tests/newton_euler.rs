//! Newton-Euler of every single body, D F = Q of Appendix A, and inverse dynamics.

use nalgebra::{Matrix3, Matrix6x3, Vector3, Vector6};
use num_dual::{Dual2_64, Dual64};
use proptest::prelude::*;
use rps3::dynamics::{
    Demand, DriveDemand, Evaluation, Inputs, InverseDynamics, JointForces, MechanismParameters, PlantModel, PlantState,
    TrajectoryPoint, derivative, evaluate, joint_forces, reactions,
};
use rps3::mechanism::{Geometry, Limb, Pose, singular_heights};

fn parameters(revolute_motors: bool) -> MechanismParameters {
    MechanismParameters { revolute_motors, ..MechanismParameters::default() }
}

fn model(revolute_motors: bool) -> PlantModel<f64> {
    PlantModel::without_stops(&parameters(revolute_motors))
}

fn vector(x: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(x)
}

prop_compose! {
    /// A state in the workspace with currents of up to 5 A.
    fn states()(
        heave in 0.02..0.09_f64, tilt in 0.0..0.3_f64, direction in 0.0..std::f64::consts::TAU,
        rates in prop::array::uniform3(-1.0..1.0_f64), currents in prop::array::uniform6(-5.0..5.0_f64),
    ) -> PlantState<f64> {
        let head = [heave, tilt * direction.cos(), tilt * direction.sin()];
        PlantState::from_iterator(head.into_iter().chain(rates).chain(currents))
    }
}

prop_compose! {
    fn loads()(f in prop::array::uniform6(-50.0..50.0_f64)) -> Inputs<f64> {
        Inputs { force: vector(&f[..3]), moment: vector(&f[3..]) * 0.1, ..Inputs::zero() }
    }
}

/// Distance in heave to the next singular pose, m.
fn clearance(s: &[f64]) -> f64 {
    let g = model(true).geometry;
    singular_heights(&g, s[1], s[2]).iter().map(|h| (h - s[0]).abs()).fold(f64::MAX, f64::min)
}

/// Position, velocity and acceleration of every link's centre of mass and of the limb angles along
/// the motion, by differentiating positions twice.
struct LinkMotion {
    lower: Vector3<Dual2_64>,
    upper: Vector3<Dual2_64>,
    joint: Vector3<f64>,
    angle: Dual2_64,
    length: Dual2_64,
}

fn link_motions(x: &PlantState<f64>, acceleration: &Vector3<f64>) -> [LinkMotion; 3] {
    let p = parameters(true);
    let g = Geometry::<Dual2_64>::new(p.base_radius.into(), p.joint_spacing.into());
    let s = Vector3::from_fn(|k, _| Dual2_64::new(x[k], x[3 + k], acceleration[k]));
    let limbs = Limb::all(&g, &Pose::new(&g, &s));
    [0, 1, 2].map(|i| {
        let limb = &limbs[i];
        let base = g.radial[i] * g.base_radius;
        LinkMotion {
            lower: base + limb.axial * Dual2_64::from(p.lower_com),
            upper: base + limb.axial * (limb.length - p.upper_com),
            joint: (base + limb.axial * limb.length).map(|x| x.re),
            angle: limb.angle(),
            length: limb.length,
        }
    })
}

/// What a planar body needs of forces and of the moment about `about`, beyond its weight.
fn demand(
    mass: f64,
    inertia: f64,
    com: &Vector3<Dual2_64>,
    angle: Dual2_64,
    normal: &Vector3<f64>,
    about: &Vector3<f64>,
    gravity: f64,
) -> (Vector3<f64>, Vector3<f64>) {
    let force = (com.map(|x| x.v2) + Vector3::z() * gravity) * mass;
    let lever = com.map(|x| x.re) - about;
    (force, lever.cross(&force) + normal * (inertia * angle.v2))
}

proptest! {
    #[test]
    fn free_body_balance_of_every_body_closes(x in states(), u in loads(), six in any::<bool>()) {
        let (p, m) = (parameters(six), model(six));
        let mut x = x;
        if !six { x.fixed_rows_mut::<3>(9).fill(0.0); }
        let e = evaluate(&m, &x, &u);
        let r = reactions(&m, &e, &u);
        let scale = 1.0 + r.axial.amax() + r.normal.amax() + r.lateral.amax();
        let mut on_platform = (u.force, u.moment);
        for (i, links) in link_motions(&x, &e.acceleration).into_iter().enumerate() {
            let limb = &e.limbs[i];
            let a = m.geometry.radial[i] * p.base_radius;
            let force = limb.axial * r.axial[i] + limb.normal * r.normal[i] + limb.lateral * r.lateral[i];
            on_platform.0 += force;
            on_platform.1 += limb.arm.cross(&force);
            // the upper link gets what the lower one hands over, less the force on the platform
            let (needed, needed_moment) =
                demand(p.upper_mass, p.upper_inertia, &links.upper, links.angle, &limb.lateral, &a, p.gravity);
            let slide = (needed + force, needed_moment + (links.joint - a).cross(&force));
            // along the slide nothing but the drive acts
            let drive = e.leg_forces[i] - m.motors.leg.reflected_inertia * links.length.v2;
            prop_assert!((slide.0.dot(&limb.axial) - drive).abs() < 1e-9 * scale);
            // the lower link: base joint, less what it hands over; about its axis only the drive acts
            let (_, lower_moment) =
                demand(p.lower_mass, p.lower_inertia, &links.lower, links.angle, &limb.lateral, &a, p.gravity);
            let base = lower_moment + slide.1;
            let drive = e.revolute_torques[i] - m.motors.revolute.reflected_inertia * links.angle.v2;
            prop_assert!((base.dot(&limb.lateral) - drive).abs() < 1e-9 * scale);
        }
        // the platform, its accelerations from its position and orientation differentiated twice
        let g = Geometry::<Dual2_64>::new(p.base_radius.into(), p.joint_spacing.into());
        let s = Vector3::from_fn(|k, _| Dual2_64::new(x[k], x[3 + k], e.acceleration[k]));
        let pose = Pose::new(&g, &s);
        let (rotation, rate, second) =
            (pose.rotation.map(|x| x.re), pose.rotation.map(|x| x.v1), pose.rotation.map(|x| x.v2));
        let cross = rate * rotation.transpose();
        let cross_rate = second * rotation.transpose() + rate * rate.transpose();
        let axis = |m: &Matrix3<f64>| Vector3::new(m.m32, m.m13, m.m21);
        let (omega, alpha) = (axis(&cross), axis(&cross_rate));
        let (ixx, izz) = p.plate_inertia();
        let inertia = rotation * Matrix3::from_diagonal(&Vector3::new(ixx, ixx, izz)) * rotation.transpose();
        let force = (pose.position.map(|x| x.v2) + Vector3::z() * p.gravity) * p.plate_mass;
        let moment = inertia * alpha + omega.cross(&(inertia * omega));
        prop_assert!((on_platform.0 - force).amax() < 1e-9 * scale);
        prop_assert!((on_platform.1 - moment).amax() < 1e-9 * scale);
    }

    #[test]
    fn newton_euler_system_gives_the_forces_of_the_forward_dynamics(x in states(), u in loads()) {
        // D F = Q knows nothing of the leg motors' currents, the reactions were made of them
        prop_assume!(clearance(x.as_slice()) > 5e-3);
        let m = model(true);
        let e = evaluate(&m, &x, &u);
        let (f, r) = (joint_forces(&m, &e, &u), reactions(&m, &e, &u));
        let tolerance = 1e-9 * (1.0 + r.axial.amax() + r.normal.amax() + r.lateral.amax());
        prop_assert_eq!(f.rank, 6);
        prop_assert!((f.reactions.axial - r.axial).amax() < tolerance, "condition {}", f.condition);
        prop_assert!((f.reactions.normal - r.normal).amax() < tolerance);
        prop_assert!((f.reactions.lateral - r.lateral).amax() < tolerance);
        prop_assert!((f.leg_forces - e.leg_forces).amax() < tolerance);
        prop_assert!(f.residual < tolerance);
    }

    #[test]
    fn newton_euler_system_stays_finite_at_singular_poses(x in states(), offset in -13.0..-3.0_f64) {
        let m = model(true);
        let heave = singular_heights(&m.geometry, x[1], x[2])[0];
        for offset in [0.0, 10f64.powf(offset)] {
            let mut x = x;
            x[0] = heave + offset;
            prop_assume!(Limb::all(&m.geometry, &Pose::new(&m.geometry, &vector(&x.as_slice()[..3]))).iter().all(|l| l.length > 0.05));
            let e = evaluate(&m, &x, &Inputs::zero());
            let f = joint_forces(&m, &e, &Inputs::zero());
            let finite = |v: &Vector3<f64>| v.iter().all(|x| x.is_finite());
            prop_assert!(finite(&f.reactions.axial) && finite(&f.reactions.lateral) && finite(&f.leg_forces));
            prop_assert!(f.condition.is_finite() && f.condition > 10.0);
            // what Q asks for is what these motors do exert, so the forces found balance it, even though not uniquely
            let scale = 1.0 + e.leg_forces.amax() + e.revolute_torques.amax() / 0.1;
            prop_assert!(f.residual < 1e-6 * scale, "{} {}", f.residual, f.rank);
        }
    }

    #[test]
    fn inverse_dynamics_inverts_forward_dynamics_of_three_motors(x in states(), u in loads(), v in prop::array::uniform3(-40.0..40.0_f64)) {
        prop_assume!(clearance(x.as_slice()) > 5e-3);
        let m = model(false);
        let mut x = x;
        x.fixed_rows_mut::<3>(9).fill(0.0);
        let inputs = Inputs { v_leg: Vector3::from(v), ..u };
        let e = evaluate(&m, &x, &inputs);
        let demand = InverseDynamics::new(&parameters(false)).demand(&point(false, &x, &inputs), &u);
        let currents = vector(&x.as_slice()[6..9]);
        let accuracy = 1e-12 * demand.condition;
        prop_assert!((demand.leg.current - currents).amax() < 1e-9 + accuracy);
        prop_assert!((demand.leg.voltage - inputs.v_leg).amax() < 1e-9 + 1e3 * accuracy, "{}", demand.leg.voltage);
        prop_assert!(demand.shortfall < 1e-9);
        let friction = Vector3::from_fn(|i, _| m.motors.leg.reflected_friction * e.limb_motions[i].length_rate);
        prop_assert!((demand.joint_forces.leg_forces - (demand.leg.joint - friction)).amax() < 1e-7 + 1e4 * accuracy);
        prop_assert_eq!(demand.revolute.voltage, Vector3::zeros());
        prop_assert!((demand.leg.torque - currents * 0.21).amax() < 1e-9);
    }

    #[test]
    fn six_motors_at_the_demanded_currents_and_voltages_make_the_demanded_motion(
        x in states(), u in loads(), jerk in prop::array::uniform3(-50.0..50.0_f64), acceleration in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        // singular poses included: with revolute motors nothing degenerates
        let m = model(true);
        let s = point_of(&x, Vector3::from(acceleration), Vector3::from(jerk));
        let demand = InverseDynamics::new(&parameters(true)).demand(&s, &u);
        let mut x = x;
        x.fixed_rows_mut::<3>(6).copy_from(&demand.leg.current);
        x.fixed_rows_mut::<3>(9).copy_from(&demand.revolute.current);
        let inputs = Inputs { v_leg: demand.leg.voltage, v_rev: demand.revolute.voltage, ..u };
        prop_assume!(inputs.v_leg.amax() < m.motors.v_max && inputs.v_rev.amax() < m.motors.v_max);
        let e = evaluate(&m, &x, &inputs);
        prop_assert!((e.acceleration - s.acceleration).amax() < 1e-9);
        // and the motion's derivative is the demanded jerk
        let along = PlantModel::<Dual64>::without_stops(&parameters(true).map(Dual64::from));
        let xd = x.zip_map(&e.derivative, Dual64::new);
        let loads = Inputs { force: u.force.map(Dual64::from), moment: u.moment.map(Dual64::from), ..Inputs::zero() };
        let found = evaluate(&along, &xd, &loads).acceleration.map(|a| a.eps);
        prop_assert!((found - s.jerk).amax() < 1e-7, "{found}");
        // least norm: no current within the null space of the map
        prop_assert!(demand.shortfall < 1e-9);
    }

    #[test]
    fn demanded_voltages_change_the_currents_as_the_demand_does(
        six in any::<bool>(), x in states(), u in loads(), jerk in prop::array::uniform3(-50.0..50.0_f64),
        acceleration in prop::array::uniform3(-5.0..5.0_f64),
    ) {
        // with six motors also within the null space of the map, where currents of any rate make the same motion
        prop_assume!(six || clearance(x.as_slice()) > 0.01);
        let (p, m, inverse) = (parameters(six), model(six), InverseDynamics::new(&parameters(six)));
        let (start, jerk) = (point_of(&x, Vector3::from(acceleration), Vector3::from(jerk)), Vector3::from(jerk));
        let at = |t: f64| {
            let acceleration = start.acceleration + jerk * t;
            let velocity = start.velocity + (start.acceleration + jerk * (0.5 * t)) * t;
            let position = start.position + (start.velocity + (start.acceleration / 2.0 + jerk * (t / 6.0)) * t) * t;
            inverse.demand(&TrajectoryPoint { position, velocity, acceleration, jerk }, &u)
        };
        // central differences of fourth order
        let (step, now) = (2e-5, at(0.0));
        let nearby = [-2.0, -1.0, 1.0, 2.0].map(|k| at(k * step));
        let rate = |current: fn(&Demand) -> Vector3<f64>| {
            let [a, b, c, d] = nearby.each_ref().map(current);
            ((c - b) * 8.0 - (d - a)) / (12.0 * step)
        };
        let motions = evaluate(&m, &x, &u).limb_motions;
        for (demand, found, drive, rates) in [
            (now.leg, rate(|demand| demand.leg.current), m.motors.leg, motions.map(|r| r.length_rate)),
            (now.revolute, rate(|demand| demand.revolute.current), m.motors.revolute, motions.map(|r| r.angle_rate)),
        ] {
            if demand == DriveDemand::default() {
                continue;
            }
            let inductive = demand.voltage - demand.current * p.motor_ra - Vector3::from(rates) * drive.force_constant;
            let told = inductive / p.motor_la;
            prop_assert!((told - found).amax() < 1e-6 * (1.0 + found.amax()), "{told} {found}");
        }
    }

    #[test]
    fn printed_d_holds_the_columns_of_the_axial_forces(x in states()) {
        // (A.1): moments about z, y, x of the platform's frame, then forces in the base frame
        let m = model(true);
        let e = evaluate(&m, &x, &Inputs::zero());
        let rotation = e.pose.rotation;
        let mut printed = Matrix6x3::zeros();
        for (i, limb) in e.limbs.iter().enumerate() {
            let arm = rotation.tr_mul(&limb.arm);
            let (in_platform, in_base) = (rotation.tr_mul(&limb.axial), limb.axial);
            printed.set_column(i, &Vector6::new(
                arm.x * in_platform.y - arm.y * in_platform.x,
                -arm.x * in_platform.z,
                arm.y * in_platform.z,
                in_base.x, in_base.y, in_base.z,
            ));
            let moment = arm.cross(&in_platform);
            let expected = Vector6::new(moment.z, moment.y, moment.x, limb.axial.x, limb.axial.y, limb.axial.z);
            prop_assert!((printed.column(i) - expected).amax() < 1e-15);
        }
        // erratum: six equations, three unknowns; the lateral forces, which it leaves out, are no rounding errors
        let r = reactions(&m, &e, &Inputs::zero());
        prop_assert!(r.lateral.amax() > 1e-4 * r.axial.amax(), "{} {}", r.lateral, r.axial);
    }
}

fn point_of(x: &PlantState<f64>, acceleration: Vector3<f64>, jerk: Vector3<f64>) -> TrajectoryPoint {
    let x = x.as_slice();
    TrajectoryPoint { position: vector(&x[..3]), velocity: vector(&x[3..6]), acceleration, jerk }
}

/// The trajectory that the forward dynamics make of a state, its third derivative by dual numbers.
fn point(revolute_motors: bool, x: &PlantState<f64>, inputs: &Inputs<f64>) -> TrajectoryPoint {
    let p = parameters(revolute_motors);
    let x_dot = derivative(&PlantModel::without_stops(&p), x, inputs);
    let along = PlantModel::<Dual64>::without_stops(&p.map(Dual64::from));
    let lift = |v: &Vector3<f64>| v.map(Dual64::from);
    let inputs = Inputs {
        v_leg: lift(&inputs.v_leg),
        v_rev: lift(&inputs.v_rev),
        force: lift(&inputs.force),
        moment: lift(&inputs.moment),
    };
    let e: Evaluation<Dual64> = evaluate(&along, &x.zip_map(&x_dot, Dual64::new), &inputs);
    point_of(x, e.acceleration.map(|a| a.re), e.acceleration.map(|a| a.eps))
}

#[test]
fn three_motors_at_a_singular_pose_fall_short_and_say_so() {
    let p = parameters(false);
    let g = Geometry::new(p.base_radius, p.joint_spacing);
    let (tilt_x, tilt_y) = (0.107, 0.0897);
    let heave = *singular_heights(&g, tilt_x, tilt_y).last().unwrap();
    let rest = Vector3::zeros();
    let s = TrajectoryPoint {
        position: Vector3::new(heave, tilt_x, tilt_y),
        velocity: rest,
        acceleration: rest,
        jerk: rest,
    };
    let three = InverseDynamics::new(&p).demand(&s, &Inputs::zero());
    assert!(three.condition > 1e9 && three.shortfall > 0.1, "{} {}", three.condition, three.shortfall);
    assert!(three.leg.current.iter().chain(&three.leg.voltage).all(|x| x.is_finite()));
    assert_eq!(three.joint_forces.rank, 5);
    let six = InverseDynamics::new(&parameters(true)).demand(&s, &Inputs::zero());
    assert!(six.condition < 1e3 && six.shortfall < 1e-9, "{} {}", six.condition, six.shortfall);
}

#[test]
fn condition_grows_with_the_inverse_distance_to_the_singularity() {
    let m = model(true);
    let (tilt_x, tilt_y) = (0.107, 0.0897);
    let heave = *singular_heights(&m.geometry, tilt_x, tilt_y).last().unwrap();
    let condition = |offset: f64| {
        let mut x = PlantState::zeros();
        (x[0], x[1], x[2]) = (heave + offset, tilt_x, tilt_y);
        joint_forces(&m, &evaluate(&m, &x, &Inputs::zero()), &Inputs::zero()).condition
    };
    for offset in [1e-4, 1e-5, 1e-6] {
        let ratio = condition(offset / 10.0) / condition(offset);
        assert!((ratio - 10.0).abs() < 0.1, "{ratio}");
    }
    assert!(condition(0.0) > 1.0 / JointForces::CUTOFF);
}

#[test]
fn printed_signs_of_the_rotor_s_inertia_contradict_each_other() {
    // (6.5): a limb turning freely with its motor, (I + J_m) alpha = K_T i at rest, pushes nothing.
    // The second equation (about z) says so; the first (about y), with -I alpha + J_m alpha, does not.
    let (inertia, rotor, torque) = (0.02, 0.09, 1.1);
    let alpha = torque / (inertia + rotor);
    let about_z = inertia * alpha + rotor * alpha - torque;
    let about_y = -inertia * alpha + rotor * alpha - torque;
    assert!(f64::abs(about_z) < 1e-15 && f64::abs(about_y) > 0.1);
    // with the signs that (6.4) gives the first: -(I + J_m) alpha - B omega + K_T i
    assert!(f64::abs(-inertia * alpha - rotor * alpha + torque) < 1e-15);
}

#[test]
fn printed_limb_equation_leaves_out_the_limb_s_weight() {
    // (6.5) takes moments about the link's centre with the force at B alone; at rest it says that
    // the motor's torque is all that reaches the platform. About A the weight's moment is there.
    let m = model(true);
    let mut x = PlantState::zeros();
    x[0] = 0.05;
    let e = evaluate(&m, &x, &Inputs::zero());
    let mut still = e;
    still.acceleration = Vector3::zeros();
    // no currents, no motion: printed F_pi normal to the limb is 0
    let normal = joint_forces(&m, &still, &Inputs::zero()).reactions.normal;
    let p = parameters(true);
    let limb = &e.limbs[0];
    let weight = p.gravity * (p.lower_mass * p.lower_com + p.upper_mass * (limb.length - p.upper_com)) * limb.cos;
    assert!((normal[0] + weight / limb.length).abs() < 1e-12 && normal[0] < -1.0, "{normal}");
}

#[test]
fn printed_rotation_matrix_is_the_zyz_one() {
    // (2.2)
    let (phi, theta, psi) = (0.7_f64, 0.4_f64, -1.9_f64);
    let (s, c) = (f64::sin, f64::cos);
    let printed = Matrix3::new(
        c(phi) * c(psi) * c(theta) - s(phi) * s(psi),
        -c(phi) * c(theta) * s(psi) - s(phi) * c(psi),
        c(phi) * s(theta),
        s(phi) * c(psi) * c(theta) + c(phi) * s(psi),
        -s(psi) * c(theta) * s(phi) + c(psi) * c(phi),
        s(phi) * s(theta),
        -s(theta) * c(psi),
        s(theta) * s(psi),
        c(theta),
    );
    let about = |axis, angle| nalgebra::Rotation3::new(axis * angle);
    let expected = about(Vector3::z(), phi) * about(Vector3::y(), theta) * about(Vector3::z(), psi);
    assert!((printed - expected.matrix()).amax() < 1e-15);
}
