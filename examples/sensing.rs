//! Prints what the sensor errors of Table 1 cost on the default crossing, by the pose filter's time constant and by
//! whether the controller knows that lengths can have a static error, and what errors cost that its sensor model
//! does not have: `cargo run --release --example sensing [seeds, default 40]`.

use nalgebra::Vector3;
use rand::distr::{Distribution as _, Uniform};
use rand::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::{Controller, Measurement, ReferencePoint};
use rps3::coupling::Experiment;
use rps3::defaults as d;
use rps3::dynamics::PlantModel;
use rps3::study::{Crossing, Distribution};

/// From here on the estimate has settled, s.
const SETTLED: f64 = 0.2;

fn main() -> anyhow::Result<()> {
    let seeds = std::env::args().nth(1).map_or(Ok(40), |argument| argument.parse())?;
    println!("Default crossing in mode 4; largest errors of {seeds} seeds, median and 90 %, mm.\n");
    println!("| motors | static error | filter, s | estimate | estimate after {SETTLED} s | pose | pose at the end |");
    println!("|---|---|---:|---|---|---|---|");
    for (variant, revolute_motors) in VARIANTS {
        for (name, bias, known) in [
            ("none", 0.0, true),
            ("up to 3 mm", d::SENSOR_LENGTH_BIAS, true),
            ("up to 3 mm, not estimated", d::SENSOR_LENGTH_BIAS, false),
        ] {
            for filter_time in [0.0, d::FILTER_TIME, 0.2] {
                let mut experiment = Crossing::default().experiment(revolute_motors);
                experiment.controller.sensors.scale = 1.0;
                experiment.controller.sensors.length_bias = if known { bias } else { 0.0 };
                experiment.controller.filter_time = filter_time;
                let cells = cells(&mut experiment, seeds, |mut rng| {
                    let unknown = if known { Vector3::zeros() } else { uniform(&mut rng, bias) };
                    move |measured: &mut Measurement<f64>| measured.lengths += unknown
                });
                println!("| {variant} | {name} | {filter_time} | {} |", cells.join(" | "));
            }
        }
    }
    println!("\nAll errors of the sensor model, and one that it does not have:\n");
    println!("| motors | besides | estimate | estimate after {SETTLED} s | pose | pose at the end |");
    println!("|---|---|---|---|---|---|");
    for (variant, revolute_motors) in VARIANTS {
        for error in &FOREIGN {
            let mut experiment = Crossing::default().experiment(revolute_motors);
            experiment.controller.sensors.scale = 1.0;
            let cells = cells(&mut experiment, seeds, |rng| error.drawn(rng));
            println!("| {variant} | {} | {} |", error.name, cells.join(" | "));
        }
    }
    Ok(())
}

const VARIANTS: [(&str, bool); 2] = [("six", true), ("three", false)];

/// Errors of readings, uniform within +- these.
struct Foreign {
    name: &'static str,
    /// Static, of each angle, rad.
    angles: f64,
    /// Static, of each length rate, m/s.
    length_rates: f64,
    /// At each tick anew, of each length rate, m/s, and of each angle rate, rad/s.
    rate_noise: (f64, f64),
}

const NONE: Foreign = Foreign { name: "none", angles: 0.0, length_rates: 0.0, rate_noise: (0.0, 0.0) };
const FOREIGN: [Foreign; 4] = [
    NONE,
    Foreign { name: "angles off by up to 0.1 deg", angles: 0.1_f64.to_radians(), ..NONE },
    Foreign { name: "length rates off by up to 1 mm/s", length_rates: 1e-3, ..NONE },
    Foreign { name: "noise of rates up to 20 mm/s, 0.1 rad/s", rate_noise: (0.02, 0.1), ..NONE },
];

impl Foreign {
    /// With static errors drawn from `rng`, from which the noise comes as well.
    fn drawn(&self, mut rng: Xoshiro256PlusPlus) -> impl FnMut(&mut Measurement<f64>) {
        let (angles, length_rates) = (uniform(&mut rng, self.angles), uniform(&mut rng, self.length_rates));
        move |measured| {
            measured.angles += angles;
            measured.length_rates += length_rates + uniform(&mut rng, self.rate_noise.0);
            measured.angle_rates += uniform(&mut rng, self.rate_noise.1);
        }
    }
}

/// Median and 90 % of the [`peaks`], mm, over `seeds`; `errors` makes from a generator what changes the readings.
fn cells<E: FnMut(&mut Measurement<f64>)>(
    experiment: &mut Experiment,
    seeds: u64,
    errors: impl Fn(Xoshiro256PlusPlus) -> E,
) -> [String; 4] {
    let mut columns = [const { Vec::new() }; 4];
    for seed in 0..seeds {
        experiment.controller.seed = seed;
        let error = errors(Xoshiro256PlusPlus::seed_from_u64(seed));
        for (column, peak) in columns.iter_mut().zip(peaks(experiment, error)) {
            column.push(peak * 1e3);
        }
    }
    columns.map(|mut column| {
        let Distribution { median, ninety, .. } = Distribution::of(&mut column);
        format!("{median:.2}, {ninety:.2}")
    })
}

/// Three numbers within +-`largest`.
fn uniform(rng: &mut impl Rng, largest: f64) -> Vector3<f64> {
    let uniform = Uniform::new_inclusive(-largest, largest).expect("a range");
    Vector3::from_fn(|_, _| uniform.sample(rng))
}

/// Largest errors of the estimate over the run and after [`SETTLED`], of the pose over the run and at its end, m;
/// `error` changes the readings before the controller's own sensor model does.
fn peaks(experiment: &Experiment, mut error: impl FnMut(&mut Measurement<f64>)) -> [f64; 4] {
    let r_b = PlantModel::<f64>::without_stops(&experiment.plant.mechanism).geometry.joint_radius;
    let mut controller = Controller::new(experiment.controller).expect("parameters that make sense");
    let external = ReferencePoint::default();
    let mut peaks = [0.0_f64; 4];
    let outcome = experiment.run_with(
        |t, measured| {
            let mut measured = *measured;
            error(&mut measured);
            controller.tick(t, &measured, &external, &experiment.tuning, true)
        },
        |record| {
            let (estimated, pose) = (record.estimate_error(r_b), record.pose_error(r_b));
            peaks[0] = peaks[0].max(estimated);
            if record.time >= SETTLED {
                peaks[1] = peaks[1].max(estimated);
            }
            peaks[2] = peaks[2].max(pose);
            peaks[3] = pose;
        },
    );
    if outcome.is_ok() { peaks } else { [f64::INFINITY; 4] }
}
