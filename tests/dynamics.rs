//! Facts of the plant's dynamics: Lagrange's equations, energy, reactions.

use nalgebra::Vector3;
use num_dual::Dual64;
use proptest::prelude::*;
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{
    Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative, electric_power, energy, evaluate, reactions,
    settled_currents,
};
use rps3::mechanism::{Limb, Pose};
use rps3::scalar::Scalar;

fn model<T: Scalar>(revolute_motors: bool) -> PlantModel<T> {
    let mut parameters = PlantParameters::default();
    parameters.mechanism.revolute_motors = revolute_motors;
    PlantModel::new(&parameters.map(T::from))
}

prop_compose! {
    /// A state within the limits, currents of up to 5 A.
    fn states()(
        heave in 0.02..0.09_f64, tilt in 0.0..0.2_f64, direction in 0.0..std::f64::consts::TAU,
        rates in prop::array::uniform3(-1.0..1.0_f64), currents in prop::array::uniform6(-5.0..5.0_f64),
    ) -> PlantState<f64> {
        let head = [heave, tilt * direction.cos(), tilt * direction.sin()];
        PlantState::from_iterator(head.into_iter().chain(rates).chain(currents))
    }
}

prop_compose! {
    fn inputs()(v in prop::array::uniform6(-60.0..60.0_f64), f in prop::array::uniform6(-50.0..50.0_f64)) -> Inputs<f64> {
        Inputs {
            v_leg: Vector3::new(v[0], v[1], v[2]),
            v_rev: Vector3::new(v[3], v[4], v[5]),
            force: Vector3::new(f[0], f[1], f[2]),
            moment: Vector3::new(f[3], f[4], f[5]) * 0.1,
        }
    }
}

proptest! {
    #[test]
    fn power_balance_holds_at_every_state(x in states(), u in inputs(), six in any::<bool>()) {
        // d(energy)/dt = electric power - losses + power of the external wrench; this pins M, h and
        // all forces together, since energy is computed from M and the potential alone.
        let mut x = x;
        if !six { for k in 9..12 { x[k] = 0.0; } }
        let m = model::<f64>(six);
        let e = evaluate(&m, &x, &u);
        let md = model::<Dual64>(six);
        let xd = x.zip_map(&e.derivative, Dual64::new);
        let energy_rate = energy(&md, &xd).eps;
        let friction: f64 = e.limb_motions.iter().map(|r| {
            m.motors.leg.reflected_friction * r.length_rate.powi(2)
                + m.motors.revolute.reflected_friction * r.angle_rate.powi(2)
        }).sum();
        let copper = m.motors.resistance * x.fixed_rows::<6>(6).norm_squared();
        let external = u.force.dot(&e.motion.velocity) + u.moment.dot(&e.motion.angular_velocity);
        let balance = electric_power(&m, &x, &u) - friction - copper + external;
        let scale = 1.0 + energy_rate.abs() + copper + balance.abs();
        prop_assert!((energy_rate - balance).abs() < 1e-9 * scale, "{energy_rate} {balance}");
    }

    #[test]
    fn forward_dynamics_obeys_lagrange_s_equations(x in states()) {
        // d/dt dL/ds_dot - dL/ds = Q component by component (the power balance alone is blind to
        // forces that do no work). dL/ds_dot = M s_dot along the motion, dL/ds by dual numbers.
        let m = model::<f64>(true);
        let e = evaluate(&m, &x, &Inputs::zero());
        let s_ddot = e.acceleration;
        let lagrangian = |x: &PlantState<Dual64>| {
            let md = model::<Dual64>(true);
            let (pose, s_dot) = (Pose::new(&md.geometry, &Vector3::new(x[0], x[1], x[2])), Vector3::new(x[3], x[4], x[5]));
            let limbs = Limb::all(&md.geometry, &pose);
            let mass = md.bodies.mass_matrix(&pose, &limbs, &md.motors);
            (mass * s_dot, s_dot.dot(&(mass * s_dot)) * Dual64::from(0.5) - md.bodies.potential_energy(&pose, &limbs))
        };
        let along_motion = PlantState::from_fn(|i, _| match i {
            0..3 => Dual64::new(x[i], x[3 + i]),
            3..6 => Dual64::new(x[i], s_ddot[i - 3]),
            _ => Dual64::from(x[i]),
        });
        let momentum_rate = lagrangian(&along_motion).0.map(|p| p.eps);
        for k in 0..3 {
            let mut toward = x.map(Dual64::from);
            toward[k].eps = 1.0;
            let gradient = lagrangian(&toward).1.eps;
            let force: f64 = (0..3).map(|i| {
                e.limbs[i].length_gradient[k] * e.leg_forces[i] + e.limbs[i].angle_gradient[k] * e.revolute_torques[i]
            }).sum();
            prop_assert!((momentum_rate[k] - gradient - force).abs() < 1e-9 * (1.0 + force.abs()), "coordinate {k}");
        }
    }

    #[test]
    fn reactions_close_the_platform_s_balance(x in states(), u in inputs(), six in any::<bool>()) {
        // Six equations, nine forces of which three only are fitted: the residual tells of errors
        // in the limbs' equations and in the accelerations.
        let m = model::<f64>(six);
        let e = evaluate(&m, &x, &u);
        let r = reactions(&m, &e, &u);
        let linear = e.motion.linear_bias + e.pose.linear_map * e.acceleration;
        let angular = e.motion.angular_bias + e.pose.angular_map * e.acceleration;
        let (force, moment) = m.bodies.plate_wrench(&e.pose, &e.motion.angular_velocity, &linear, &angular);
        let (mut f, mut t) = (u.force, u.moment);
        for i in 0..3 {
            let limb = &e.limbs[i];
            let on_platform = limb.axial * r.axial[i] + limb.normal * r.normal[i] + limb.lateral * r.lateral[i];
            f += on_platform;
            t += limb.arm.cross(&on_platform);
        }
        let scale = 1.0 + r.axial.amax() + r.normal.amax() + r.lateral.amax();
        prop_assert!((f - force).amax() < 1e-9 * scale && (t - moment).amax() < 1e-9 * scale);
    }
}

#[test]
fn settled_currents_leave_the_plant_at_rest() {
    for six in [true, false] {
        let m = model::<f64>(six);
        let start = Vector3::from(PlantParameters::default().start);
        let (leg, rev) = settled_currents(&m, &start, &Inputs::zero()).unwrap();
        let mut x = PlantState::zeros();
        x.fixed_rows_mut::<3>(0).copy_from(&start);
        x.fixed_rows_mut::<3>(6).copy_from(&leg);
        x.fixed_rows_mut::<3>(9).copy_from(&rev);
        assert!(evaluate(&m, &x, &Inputs::zero()).acceleration.amax() < 1e-12);
    }
}

#[test]
fn without_friction_and_currents_energy_is_conserved_over_a_second() {
    // open circuit is not available; take resistance so large that no current flows to speak of
    let mut parameters = PlantParameters::default();
    parameters.mechanism.motor_bm = 0.0;
    parameters.mechanism.revolute_motors = false;
    parameters.mechanism.motor_kt = 1e-9;
    parameters.stop_damping = 0.0;
    parameters.start = [0.09, 0.05, 0.02];
    let m = PlantModel::new(&parameters);
    let mut x = PlantState::zeros();
    x.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(parameters.start));
    let before = energy(&m, &x);
    let settings = Settings { tolerance: 1e-9, nominal: NOMINAL, max_step: 0.01 };
    Solver::default().integrate(|_, x| derivative(&m, x, &Inputs::zero()), &mut x, 0.0, 1.0, &settings).unwrap();
    let drift = (energy(&m, &x) - before).abs() / before.abs();
    assert!((x[0] - 0.09).abs() > 1e-3, "it did fall: {x}");
    assert!(drift < 1e-6, "{drift:e}");
}
