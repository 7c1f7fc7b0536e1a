//! What the fitness says of an acceleration, and what the voltages do to the currents.

use nalgebra::{Vector3, Vector6};
use proptest::prelude::*;
use rps3::control::{
    ControllerParameters, Estimate, Fitness, ForceDistribution, Mode, Reference, SingularBasis, Situation, Tuning,
    voltages,
};
use rps3::coupling::{Experiment, measure};
use rps3::dynamics::{Inputs, PlantModel, moving};
use rps3::study::Crossing;

const SAMPLE_TIME: f64 = 1e-3;

fn situation(
    model: &PlantModel<f64>,
    path: &Reference<f64>,
    t: f64,
    s: Vector3<f64>,
    s_dot: Vector3<f64>,
) -> Situation<f64> {
    let measured = measure(model, &moving(&s, &s_dot), &Inputs::zero());
    Situation::new(model, &Estimate { s, s_dot }, &path.at(t), &measured, &Tuning::default().gains)
}

proptest! {
    /// Six motors cause what is asked for while their voltages suffice: the fitness is then a formula of s, s_dot,
    /// s_ddot and the reference alone.
    #[test]
    fn fitness_is_the_weighed_error_that_the_acceleration_leads_to(
        t in 0.2..0.8_f64, error in prop::array::uniform3(-1e-3..1e-3_f64), rates in prop::array::uniform3(-1e-2..1e-2_f64),
        wanted in prop::array::uniform3(-0.5..0.5_f64), horizon in 2e-3..0.02_f64, weights in prop::array::uniform2(0.0..1e-2_f64),
    ) {
        let experiment = Crossing::default().experiment(true);
        let model = PlantModel::<f64>::without_stops(&experiment.plant.mechanism);
        let path = Reference::of(&experiment.controller);
        let [weight_velocity, weight_acceleration] = weights;
        let tuning = Tuning { horizon, weight_velocity, weight_acceleration, ..Tuning::default() };
        let now = path.at(t);
        let (s, s_dot) = (now.position + Vector3::from(error), now.rate + Vector3::from(rates));
        let situation = situation(&model, &path, t, s, s_dot);
        let basis = SingularBasis::new(&situation);
        let distribution = ForceDistribution::new(&model, &situation);
        let ahead = path.at(t + horizon);
        let fitness = Fitness::new(&model, &situation, &basis, &distribution, &ahead, &tuning, SAMPLE_TIME);
        let wanted = Vector3::from(wanted);
        let r_b = model.geometry.joint_radius;
        let square = |v: Vector3<f64>| v.component_mul(&Vector3::new(1.0, r_b, r_b)).norm_squared();
        let expected = square(ahead.position - s - s_dot * horizon - wanted * (0.5 * horizon * horizon))
            + weight_velocity * square(ahead.rate - s_dot - wanted * horizon)
            + weight_acceleration * square(wanted);
        let found = fitness.of_acceleration(&wanted, 0.0);
        prop_assert!((found - expected).abs() < 1e-9 * expected, "{found:e} {expected:e}");
    }

    /// The armature equation (2.3) over a sample, by the backward Euler method: what the voltages are made for.
    #[test]
    fn voltages_lead_the_currents_to_the_wanted_ones_within_a_sample(
        six in any::<bool>(), rates in prop::array::uniform3(-0.1..0.1_f64),
        wanted in prop::array::uniform6(-3.0..3.0_f64), measured in prop::array::uniform6(-3.0..3.0_f64),
    ) {
        let experiment = Crossing::default().experiment(six);
        let model = PlantModel::<f64>::without_stops(&experiment.plant.mechanism);
        let path = Reference::of(&experiment.controller);
        let situation = situation(&model, &path, 0.4, path.at(0.4).position, Vector3::from(rates));
        let (wanted, measured) = (Vector6::from(wanted), Vector6::from(measured));
        let command = voltages(&model.motors, &situation, &wanted, &measured, SAMPLE_TIME);
        prop_assume!(!command.saturated);
        let p = experiment.plant.mechanism;
        for k in 0..if six { 6 } else { 3 } {
            let rotor_rate = match k {
                0..3 => situation.length_rates[k] * std::f64::consts::TAU / p.screw_lead,
                _ => situation.angle_rates[k - 3] * p.gear_ratio,
            };
            let driving = command.voltages[k] - p.motor_kt * rotor_rate;
            let reached = (measured[k] + SAMPLE_TIME / p.motor_la * driving) / (1.0 + SAMPLE_TIME * p.motor_ra / p.motor_la);
            prop_assert!((reached - wanted[k]).abs() < 1e-12, "{k}: {reached} {}", wanted[k]);
        }
    }
}

/// With a computation delay the swarm weighs the motion from the predicted state on, against the reference as far
/// ahead of *that* instant: on an undisturbed crossing it foresees as small an error as without.
#[test]
fn with_a_computation_delay_the_fitness_looks_as_far_ahead_of_the_predicted_state() {
    let median = |computation_delay: bool| {
        let experiment = Crossing::default().experiment(true);
        let controller = ControllerParameters { computation_delay, ..experiment.controller };
        let tuning = Tuning { mode: Mode::HdracMpso, ..experiment.tuning };
        let mut fitness = Vec::new();
        let experiment = Experiment { controller, tuning, duration: 0.6, ..experiment };
        experiment.run(|record| fitness.push(record.diagnostics.fitness)).unwrap();
        fitness.sort_by(f64::total_cmp);
        fitness[fitness.len() / 2]
    };
    let (prompt, delayed) = (median(false), median(true));
    println!("median fitness without a delay {prompt:e} m2, with one {delayed:e} m2");
    assert!(delayed < 2.0 * prompt, "{prompt:e} {delayed:e}");
}
