//! Prints peak and rms pose errors of the default crossing per control mode, with and without
//! noise on the limb lengths: `cargo run --release --example crossing [six|three]`.

use rps3::control::{ControllerParameters, Damping, Mode, Tuning};
use rps3::coupling::{Experiment, Push};
use rps3::dynamics::PlantParameters;

fn main() {
    let joint_radius = rps3::defaults::JOINT_SPACING / 3.0_f64.sqrt();
    for revolute_motors in [true, false] {
        for (push, noise) in [(0.0, 0.0), (0.0, 1e-4), (100.0, 1e-4)] {
            println!("revolute motors {revolute_motors}, length noise {} mm, push {push} N", noise * 1e3);
            for (name, mode, rho, delta_hd) in [
                ("RAC", Mode::Rac, 0.0_f64, 0.0),
                ("DRAC", Mode::Drac, 0.05, 0.0),
                ("DRAC", Mode::Drac, 0.2, 0.0),
                ("HDRAC", Mode::Hdrac, 0.05, 0.1),
                ("HDRAC", Mode::Hdrac, 0.05, 0.02),
                ("HDRAC+MPSO", Mode::HdracMpso, 0.0, 0.0),
            ] {
                let mut plant = PlantParameters::default();
                plant.mechanism.revolute_motors = revolute_motors;
                let mut controller = ControllerParameters::default();
                controller.mechanism.revolute_motors = revolute_motors;
                let fixed = Damping { rho, delta_hd, lambda_f: (0.1 * rho).max(1e-3) };
                let push = (push > 0.0).then(|| Push {
                    span: (0.455, 0.495),
                    force: nalgebra::Vector3::new(0.0, 0.0, -push),
                    moment: nalgebra::Vector3::new(0.05 * push, 0.0, 0.0),
                });
                let experiment = Experiment {
                    plant,
                    controller,
                    tuning: Tuning { mode, fixed, ..Tuning::default() },
                    duration: 1.4,
                    tolerance: 1e-7,
                    push,
                    length_noise: noise,
                    noise_seed: 1,
                };
                let (mut peak, mut square, mut count, mut voltage) = (0.0_f64, 0.0, 0.0, 0.0_f64);
                let mut iterations = 0;
                let outcome = experiment.run(|record| {
                    let error = record.pose_error(joint_radius);
                    peak = peak.max(error);
                    square += error * error;
                    count += 1.0;
                    voltage = voltage.max(record.diagnostics.voltages.amax());
                    iterations += record.diagnostics.iterations;
                });
                let rms = (square / count).sqrt();
                println!(
                    "  {name:10} {rho:4} {delta_hd:4} peak {:8.4} mm  rms {:8.4} mm  {voltage:5.1} V  it {:4.1} {}",
                    peak * 1e3,
                    rms * 1e3,
                    f64::from(u32::try_from(iterations).unwrap_or(0)) / count,
                    outcome.err().map_or(String::new(), |e| e.to_string())
                );
            }
        }
    }
}
