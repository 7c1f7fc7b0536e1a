//! The Lyapunov function of section 5 on the mechanism: ideal computed torque, constant damping.

use nalgebra::Vector3;
use proptest::prelude::*;
use rps3::control::{
    ControllerParameters, Damping, Estimate, Gains, Measurement, Reference, ReferencePoint, SingularBasis, Situation,
    lyapunov, lyapunov_rate,
};
use rps3::defaults as d;
use rps3::dynamics::{PlantModel, PlantParameters};
use rps3::study::{Crossing, MODES};

const SAMPLE_TIME: f64 = 1e-3;
const DAMPING: Damping<f64> = Damping { rho: 0.05, delta_hd: 0.1, lambda_f: 0.0 };
const VIA: [f64; 3] = [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y];

fn situation(s: Vector3<f64>, s_dot: Vector3<f64>, reference: &ReferencePoint<f64>) -> Situation<f64> {
    let model = PlantModel::without_stops(&PlantParameters::default().mechanism);
    // feeds the acceleration feedback alone, which is off
    let zero = Vector3::zeros();
    let measured = Measurement {
        lengths: zero,
        length_rates: zero,
        angles: zero,
        angle_rates: zero,
        leg_currents: zero,
        revolute_currents: zero,
        acceleration: zero,
    };
    Situation::new(&model, &Estimate { s, s_dot }, reference, &measured, &Gains::default())
}

/// s_ddot of the ideal closed loop.
fn acceleration(situation: &Situation<f64>, damping: &Damping<f64>) -> Vector3<f64> {
    let basis = SingularBasis::new(situation);
    basis.coordinate_acceleration(damping.rho, damping.rho_hd(basis.sigma_min, SAMPLE_TIME))
}

fn resting(position: [f64; 3]) -> ReferencePoint<f64> {
    ReferencePoint { position: position.into(), rate: Vector3::zeros(), acceleration: Vector3::zeros() }
}

proptest! {
    #[test]
    fn rate_of_the_lyapunov_function_is_5_5_and_5_6(
        offset in prop::array::uniform3(-1.0..1.0_f64), rates in prop::array::uniform3(-0.3..0.3_f64),
        rho in 0.01..0.5_f64, delta_hd in 0.0..0.2_f64, moving in any::<bool>(),
    ) {
        // around the singular pose of the default crossing, the reference there or passing by
        let s = Vector3::from(VIA) + Vector3::new(0.01 * offset[0], 0.05 * offset[1], 0.05 * offset[2]);
        let s_dot = Vector3::from(rates);
        let damping = Damping { rho, delta_hd, lambda_f: 0.0 };
        let parameters = ControllerParameters::default();
        let path = Reference::new(parameters.waypoints.map(Vector3::from), 1.0, parameters.profile, 0.2);
        let reference = |t: f64| if moving { path.at(0.4 + t) } else { resting(VIA) };
        let now = situation(s, s_dot, &reference(0.0));
        let s_ddot = acceleration(&now, &damping);
        // Richardson's extrapolation of central differences along the motion
        let central = |h: f64| {
            let at = |t: f64| {
                let (s, s_dot) = (s + s_dot * t + s_ddot * (0.5 * t * t), s_dot + s_ddot * t);
                lyapunov(&situation(s, s_dot, &reference(t)), &Gains::default(), rho)
            };
            (at(h) - at(-h)) / (2.0 * h)
        };
        let scale = 1.0 + s_ddot.amax();
        let h = 1e-4 / scale;
        let measured = (4.0 * central(0.5 * h) - central(h)) / 3.0;
        let rho_hd = damping.rho_hd(now_sigma(&now), SAMPLE_TIME);
        let expected = lyapunov_rate(&now, &Gains::default(), rho, rho_hd);
        prop_assert!((measured - expected).abs() < 1e-6 * (expected.abs() + scale), "{measured} {expected}");
        if !moving {
            let rate = now.jacobian * now.twist;
            let by_5_6 = -d::K_D * rate.norm_squared() - rho_hd * rho * rho * now.twist.norm_squared(); // (5.6)
            prop_assert!((by_5_6 - expected).abs() <= 1e-12 * by_5_6.abs());
            prop_assert!(expected <= 0.0);
        }
    }
}

fn now_sigma(situation: &Situation<f64>) -> f64 {
    SingularBasis::new(situation).sigma_min
}

#[test]
fn lyapunov_function_never_rises_while_the_reference_rests() {
    let reference = resting(VIA);
    let (mut s, mut s_dot) = (Vector3::from(VIA) + Vector3::new(0.01, -0.03, 0.02), Vector3::new(-0.1, 0.3, 0.2));
    let rates =
        |s: Vector3<f64>, s_dot: Vector3<f64>| (s_dot, acceleration(&situation(s, s_dot, &reference), &DAMPING));
    let value = |s, s_dot| lyapunov(&situation(s, s_dot, &reference), &Gains::default(), DAMPING.rho);
    // Runge-Kutta of fourth order; the fastest mode is 1 / SAMPLE_TIME
    let h = 0.1 * SAMPLE_TIME;
    let first = value(s, s_dot);
    let mut last = first;
    for k in 0..10_000 {
        let (a1, b1) = rates(s, s_dot);
        let (a2, b2) = rates(s + a1 * (0.5 * h), s_dot + b1 * (0.5 * h));
        let (a3, b3) = rates(s + a2 * (0.5 * h), s_dot + b2 * (0.5 * h));
        let (a4, b4) = rates(s + a3 * h, s_dot + b3 * h);
        s += (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
        s_dot += (b1 + (b2 + b3) * 2.0 + b4) * (h / 6.0);
        let next = value(s, s_dot);
        assert!(next <= last * (1.0 + 1e-12), "step {k}: {last:e} -> {next:e}");
        last = next;
    }
    assert!(last < 0.2 * first && s_dot.amax() < 0.05, "{first:e} -> {last:e}, {s_dot}");
}

#[test]
fn a_changing_damping_raises_the_lyapunov_function_by_several_times_its_value() {
    // L depends on rho by rho^2 |q_dot|^2 / 2 alone, which bounds what a tick adds. What all ticks add, nothing bounds.
    let experiment = Crossing::default().experiment(true);
    let model = PlantModel::without_stops(&experiment.plant.mechanism);
    let (mut previous, mut rises, mut falls, mut largest, mut most) = (None::<f64>, 0.0, 0.0, 0.0_f64, 0.0_f64);
    let outcome = MODES[5].run(&experiment, |record| {
        let rho = record.diagnostics.damping.rho;
        let (s, s_dot) = (record.state.fixed_rows::<3>(0).into(), record.state.fixed_rows::<3>(3).into());
        let reference = Reference::new(
            experiment.controller.waypoints.map(Vector3::from),
            1.0,
            experiment.controller.profile,
            model.geometry.joint_radius,
        );
        let now = situation(s, s_dot, &reference.at(record.time));
        let kinetic = 0.5 * now.twist.norm_squared();
        let at = |rho| lyapunov(&now, &Gains::default(), rho);
        assert!(at(rho) - at(0.0) <= d::RHO_MAX * d::RHO_MAX * kinetic * (1.0 + 1e-9));
        if let Some(before) = previous {
            let step: f64 = at(rho) - at(before);
            rises += step.max(0.0);
            falls += step.min(0.0);
            largest = largest.max(step);
        }
        most = most.max(at(rho));
        previous = Some(rho);
    });
    assert_eq!(outcome, Ok(()));
    println!("L is at most {most:.2e} m2/s2; rises of rho add {rises:.2e} in all, {largest:.2e} at most in a tick;");
    println!("its falls take {falls:.2e}");
    assert!(rises > 2.0 * most && rises < 10.0 * most, "{rises:e} {most:e}");
    assert!((rises + falls).abs() < 0.5 * rises, "about as much is taken as added: {rises:e} {falls:e}");
}
