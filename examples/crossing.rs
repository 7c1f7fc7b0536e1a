//! Prints peak and rms pose errors of the default crossing for the control modes and the baselines,
//! with and without noise on the limb lengths and a push next to the singular pose, and at constant speed:
//! `cargo run --release --example crossing`.

use nalgebra::Vector3;
use rps3::control::Profile;
use rps3::coupling::{Experiment, Push};
use rps3::study::{BASELINES, Crossing, MODES};

fn main() {
    for (variant, revolute_motors) in [("six motors", true), ("three motors", false)] {
        for (length_noise, force, profile) in [
            (0.0, 0.0, Profile::Quintic),
            (1e-4, 0.0, Profile::Quintic),
            (1e-4, 100.0, Profile::Quintic),
            (0.0, 0.0, Profile::ConstantSpeed),
        ] {
            println!("\n{variant}, {profile:?}, length noise {} mm, push {force} N\n", length_noise * 1e3);
            println!("| scheme | peak, mm | rms, mm | voltage, V | iterations a tick |");
            println!("|---|---|---|---|---|");
            let push = (force > 0.0).then(|| Push {
                span: (0.455, 0.495),
                force: Vector3::new(0.0, 0.0, -force),
                moment: Vector3::new(0.05 * force, 0.0, 0.0),
            });
            let mut experiment = Experiment { push, length_noise, ..Crossing::default().experiment(revolute_motors) };
            experiment.controller.profile = profile;
            for scheme in MODES.iter().chain(&BASELINES) {
                let f = scheme.figures(&experiment);
                println!(
                    "| {} | {:.4} | {:.4} | {:.1} | {:.1} |{}",
                    scheme.name,
                    f.peak * 1e3,
                    f.rms * 1e3,
                    f.voltage,
                    f.iterations,
                    f.failure.map_or(String::new(), |e| format!(" {e}"))
                );
            }
        }
    }
}
