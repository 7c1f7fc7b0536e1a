//! The hot paths: right-hand side, Co-Simulation step, controller tick, and what a tick consists of.
//!
//! `cargo bench --bench hot_paths`; on a noisy machine compare within one run only.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Vector3;
use rps3::control::{Controller, ControllerParameters, Mode, ReferencePoint, Tuning};
use rps3::coupling::measure;
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, NOMINAL, PlantModel, PlantParameters, PlantState, derivative};
use rps3::mechanism::{Geometry, Limb, OverallJacobian, Pose};
use rps3::svd::Svd;

/// A state on the default crossing, two millimetres from the singularity.
fn state() -> PlantState<f64> {
    let d = 8.0_f64.to_radians();
    let (x, y) = (d * 0.766, d * 0.643);
    PlantState::from([0.047, x, y, -0.09, 0.15, 0.13, 0.5, 0.1, -0.3, 0.2, 0.1, 0.2])
}

fn inputs() -> Inputs<f64> {
    Inputs { v_leg: Vector3::new(3.0, -1.0, 2.0), v_rev: Vector3::new(1.0, 0.5, -1.0), ..Inputs::zero() }
}

fn plant(c: &mut Criterion) {
    let model = PlantModel::new(&PlantParameters::default());
    let (x, u) = (state(), inputs());
    c.bench_function("plant/right-hand side", |b| b.iter(|| derivative(black_box(&model), black_box(&x), &u)));
    let settings = Settings { tolerance: 1e-7, nominal: NOMINAL, max_step: f64::INFINITY };
    c.bench_function("plant/step of 1 ms", |b| {
        let mut warm = Solver::default();
        let mut scratch = x;
        warm.integrate(|_, x| derivative(&model, x, &u), &mut scratch, 0.0, 1e-3, &settings).unwrap();
        b.iter(|| {
            let (mut solver, mut x) = (warm, black_box(x));
            solver.integrate(|_, x| derivative(&model, x, &u), &mut x, 0.0, 1e-3, &settings).unwrap();
            x
        });
    });
}

fn decomposition(c: &mut Criterion) {
    let geometry = Geometry::new(rps3::defaults::BASE_RADIUS, rps3::defaults::JOINT_SPACING);
    let x = state();
    let pose = Pose::new(&geometry, &Vector3::new(x[0], x[1], x[2]));
    let jacobian = OverallJacobian::new(&geometry, &Limb::all(&geometry, &pose)).matrix;
    c.bench_function("svd of J", |b| b.iter(|| Svd::new(black_box(&jacobian))));
}

fn controller(c: &mut Criterion) {
    for (name, six) in [("six motors", true), ("three motors", false)] {
        for (mode_name, mode) in [("mode 3", Mode::Hdrac), ("mode 4", Mode::HdracMpso)] {
            let mut plant = PlantParameters::default();
            plant.mechanism.revolute_motors = six;
            let parameters = ControllerParameters { mechanism: plant.mechanism, ..ControllerParameters::default() };
            let model = PlantModel::new(&plant);
            let measured = measure(&model, &state(), &inputs());
            let external = ReferencePoint::default();
            let tuning = Tuning { mode, ..Tuning::default() };
            let mut controller = Controller::new(parameters).unwrap();
            c.bench_function(&format!("controller/tick in {mode_name}, {name}"), |b| {
                b.iter(|| controller.tick(0.49, black_box(&measured), &external, &tuning, true).unwrap());
            });
        }
    }
}

criterion_group!(benches, plant, decomposition, controller);
criterion_main!(benches);
