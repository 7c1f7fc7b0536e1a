//! Facts about the sensor model (Table 1) and the pose estimate.

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::{ControllerParameters, Deviations, Estimator, Measurement, SensorParameters, Sensors};
use rps3::coupling::measure;
use rps3::defaults as d;
use rps3::dynamics::{Inputs, PlantModel, PlantParameters, moving};
use rps3::mechanism::{Limb, Pose};

const DEVIATIONS: Deviations = Deviations { length: 1.5e-4, angle: 0.2 * d::DEG, length_bias: 1e-9 };

fn model() -> PlantModel<f64> {
    PlantModel::new(&PlantParameters::default())
}

/// What ideal sensors tell at coordinates `s` and rates `s_dot`.
fn exact(model: &PlantModel<f64>, s: [f64; 3], s_dot: [f64; 3]) -> Measurement<f64> {
    measure(model, &moving(&s.into(), &s_dot.into()), &Inputs::zero())
}

const VIA: [f64; 3] = [d::VIA_HEAVE, d::VIA_TILT_X, d::VIA_TILT_Y];

proptest! {
    #[test]
    fn exact_measurements_give_the_exact_pose_and_rates(
        heave in 0.02..0.09_f64, tilt in prop::array::uniform2(-0.15..0.15_f64), rates in prop::array::uniform3(-0.5..0.5_f64),
    ) {
        let s = [heave, tilt[0], tilt[1]];
        // first guess a crossing away
        let mut estimator = Estimator::new(&DEVIATIONS, 0.0, 1e-3, VIA);
        let model = model();
        let estimate = estimator.update(&model.geometry, &exact(&model, s, rates));
        prop_assert!((estimate.s - Vector3::from(s)).amax() < 1e-13);
        prop_assert!((estimate.s_dot - Vector3::from(rates)).amax() < 1e-12);
    }
}

#[test]
fn an_estimate_far_from_its_first_guess_is_no_false_minimum() {
    // where a search from the default start pose ends elsewhere
    for s in [[0.0623, 0.3853, -0.2165], [0.0773, -0.0257, 0.526], [-0.0313, -0.0502, 0.4055]] {
        let model = model();
        let mut estimator = Estimator::of(&ControllerParameters::default());
        let measured = exact(&model, s, [0.0; 3]);
        let plane = model.geometry.pose_of_joints(measured.lengths.into(), measured.angles.into());
        assert!((plane - Vector3::from(s)).amax() < 1e-12, "{plane}");
        let estimate = estimator.update(&model.geometry, &measured);
        assert!((estimate.s - Vector3::from(s)).amax() < 1e-12, "{}", estimate.s);
        assert_eq!(estimator.contradiction(), None);
    }
}

#[test]
fn readings_that_fit_no_pose_contradict_each_other() {
    let model = model();
    let measured = exact(&model, VIA, [0.0; 3]);
    let contradiction = |measured: Measurement<f64>| {
        let mut estimator = Estimator::of(&ControllerParameters::default());
        estimator.update(&model.geometry, &measured);
        estimator.contradiction()
    };
    assert_eq!(contradiction(measured), None);
    let degrees = Measurement { angles: measured.angles * 180.0 / std::f64::consts::PI, ..measured };
    let swapped = Measurement { lengths: measured.angles, angles: measured.lengths, ..measured };
    for (what, measured) in [("degrees", degrees), ("swapped", swapped)] {
        assert!(contradiction(measured).is_some_and(|error| error > 0.02), "{what}");
    }
}

#[test]
fn estimate_is_unbiased_and_as_precise_as_least_squares_can_be() {
    let model = model();
    let truth = exact(&model, VIA, [0.0; 3]);
    let estimator = Estimator::new(&DEVIATIONS, 0.0, 1e-3, VIA);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut gauss = |deviation: f64| {
        let z: f64 = StandardNormal.sample(&mut rng);
        deviation * z
    };
    // At a direct singularity on purpose: lengths alone would leave one direction open.
    let [lengths, angles] = gradients();
    let information = lengths * lengths.transpose() / DEVIATIONS.length.powi(2)
        + angles * angles.transpose() / DEVIATIONS.angle.powi(2);
    let covariance = information.try_inverse().expect("six sensors see every motion");
    let n = 20_000.0;
    let (mut sum, mut squares) = (Vector3::zeros(), Matrix3::zeros());
    for _ in 0..n as usize {
        let mut noisy = truth;
        for i in 0..3 {
            noisy.lengths[i] += gauss(DEVIATIONS.length);
            noisy.angles[i] += gauss(DEVIATIONS.angle);
        }
        let error = estimator.fit(&model.geometry, &noisy, &VIA.into(), false).estimate.s - Vector3::from(VIA);
        sum += error;
        squares += error * error.transpose();
    }
    for i in 0..3 {
        let deviation = covariance[(i, i)].sqrt();
        // 4 standard deviations of the mean; of the variance, whose relative one is sqrt(2 / n)
        assert!((sum[i] / n).abs() < 4.0 * deviation / n.sqrt(), "{i}: {:e}", sum[i] / n);
        let ratio = squares[(i, i)] / n / covariance[(i, i)];
        assert!((ratio - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{i}: {ratio}");
    }
}

#[test]
fn filter_averages_noise_and_does_not_lag() {
    let (model, sample_time, filter_time) = (model(), 1e-3, 0.05);
    // A steady motion through the singular pose: exact readings come through without lag.
    let rates = [-0.05, 0.1, 0.08];
    let mut estimator = Estimator::new(&DEVIATIONS, filter_time, sample_time, VIA);
    for k in 0..400 {
        let t = sample_time * f64::from(k) - 0.2;
        let s = [0, 1, 2].map(|i| VIA[i] + rates[i] * t);
        let estimate = estimator.update(&model.geometry, &exact(&model, s, rates));
        assert!((estimate.s - Vector3::from(s)).amax() < 1e-14, "{k}");
    }
    // At rest the variance falls to g / (2 - g) of a single fit's, g = 1 - exp(-sample_time / filter_time).
    let truth = exact(&model, VIA, [0.0; 3]);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let (mut fitted, mut filtered) = (0.0, 0.0);
    let fresh = Estimator::new(&DEVIATIONS, 0.0, sample_time, VIA);
    let mut estimator = Estimator::new(&DEVIATIONS, filter_time, sample_time, VIA);
    let n = 200_000;
    for k in 0..n {
        let mut noisy = truth;
        for i in 0..3 {
            let z: f64 = StandardNormal.sample(&mut rng);
            noisy.lengths[i] += DEVIATIONS.length * z;
        }
        let estimate = estimator.update(&model.geometry, &noisy);
        if k > 1000 {
            filtered += (estimate.s.x - VIA[0]).powi(2);
            fitted += (fresh.fit(&model.geometry, &noisy, &VIA.into(), false).estimate.s.x - VIA[0]).powi(2);
        }
    }
    let gain = 1.0 - (-sample_time / filter_time).exp();
    let expected = gain / (2.0 - gain);
    // about n / 100 independent values: relative deviation of the variance sqrt(2 / 2000) = 3 %
    assert!((filtered / fitted / expected - 1.0).abs() < 0.12, "{} {expected}", filtered / fitted);
}

const WITH_STATIC_ERRORS: Deviations = Deviations { length_bias: 2e-3, ..DEVIATIONS };
const RUNS: u32 = 2000;
/// 4 relative standard deviations of the mean of [`RUNS`] chi-squares of 3 degrees of freedom.
const BOUND: f64 = 0.074;

/// Mean square of the estimate's error after `readings` at rest, normalized by `information` per degree of freedom: 1 if that
/// is what the estimate has. Static errors are drawn anew in each run.
fn normalized_square(filter_time: f64, readings: u32, information: &Matrix3<f64>) -> f64 {
    let model = model();
    let truth = exact(&model, VIA, [0.0; 3]);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut gauss = |deviation: f64| {
        let z: f64 = StandardNormal.sample(&mut rng);
        deviation * z
    };
    let mut sum = 0.0;
    for _ in 0..RUNS {
        let biases = [(); 3].map(|()| gauss(WITH_STATIC_ERRORS.length_bias));
        let mut estimator = Estimator::new(&WITH_STATIC_ERRORS, filter_time, 1e-3, VIA);
        let mut error = Vector3::zeros();
        for _ in 0..readings {
            let mut noisy = truth;
            for (i, bias) in biases.iter().enumerate() {
                noisy.lengths[i] += bias + gauss(DEVIATIONS.length);
                noisy.angles[i] += gauss(DEVIATIONS.angle);
            }
            error = estimator.update(&model.geometry, &noisy).s - Vector3::from(VIA);
        }
        sum += error.dot(&(information * error));
    }
    sum / f64::from(3 * RUNS)
}

/// Gradients of lengths and angles at the singular pose, in columns.
fn gradients() -> [Matrix3<f64>; 2] {
    let geometry = model().geometry;
    let limbs = Limb::all(&geometry, &Pose::new(&geometry, &VIA.into()));
    [limbs.map(|limb| limb.length_gradient), limbs.map(|limb| limb.angle_gradient)].map(|g| Matrix3::from_columns(&g))
}

#[test]
fn static_errors_of_lengths_are_found_as_well_as_angles_tell_them() {
    let [lengths, angles] = gradients();
    let n = 100;
    // Where no reading fades, n at rest are as good as one of their mean, in which a length is uncertain by its noise and
    // its static error together.
    let mean = |deviation: f64| deviation.powi(2) / f64::from(n);
    let length_variance = mean(DEVIATIONS.length) + WITH_STATIC_ERRORS.length_bias.powi(2);
    let batch = lengths * lengths.transpose() / length_variance + angles * angles.transpose() / mean(DEVIATIONS.angle);
    let square = normalized_square(1e9, n, &batch);
    assert!((square - 1.0).abs() < BOUND, "{square}");
    // Without a filter there are n unknown poses. Each reading tells of the static errors what is left when its pose is
    // eliminated, and the last pose has what is left when they are.
    let [length, angle] = [DEVIATIONS.length, DEVIATIONS.angle].map(|deviation| deviation.powi(-2));
    let pose = lengths * lengths.transpose() * length + angles * angles.transpose() * angle;
    let shared = lengths * length;
    let told = Matrix3::from_diagonal_element(length) - shared.tr_mul(&(pose.try_inverse().unwrap() * shared));
    let errors =
        Matrix3::from_diagonal_element(WITH_STATIC_ERRORS.length_bias.powi(-2) + length) + told * f64::from(n - 1);
    let last = pose - shared * errors.try_inverse().unwrap() * shared.transpose();
    let square = normalized_square(0.0, n, &last);
    assert!((square - 1.0).abs() < BOUND, "{square}");
    // A filter in between lies in between.
    let (lower, upper) = (normalized_square(0.05, n, &batch), normalized_square(0.05, n, &last));
    assert!(lower > 1.0 - BOUND && upper < 1.0 + BOUND, "{lower} {upper}");
}

#[test]
fn sensors_have_the_resolution_the_repeatability_and_the_static_error_of_table_1() {
    let parameters = SensorParameters { scale: 1.0, ..SensorParameters::default() };
    let truth = exact(&model(), VIA, [0.1, -0.2, 0.3]);
    let mut biases = Vec::new();
    for seed in 0..200 {
        let mut sensors = Sensors::new(parameters, Xoshiro256PlusPlus::seed_from_u64(seed));
        let n = 1000.0;
        let (mut sum, mut square, mut angle_sum, mut angle_square) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..n as usize {
            let read = sensors.read(&truth);
            for (value, resolution) in [(read.lengths[0], 1e-4), (read.angles[0], 0.15 * d::DEG)] {
                let steps = value / resolution;
                assert!((steps - steps.round()).abs() < 1e-9, "{value} is no multiple of {resolution}");
            }
            assert_eq!((read.length_rates, read.angle_rates), (truth.length_rates, truth.angle_rates));
            assert_eq!((read.leg_currents, read.acceleration), (truth.leg_currents, truth.acceleration));
            let (error, angle_error) = (read.lengths[0] - truth.lengths[0], read.angles[0] - truth.angles[0]);
            sum += error / n;
            square += error * error / n;
            angle_sum += angle_error / n;
            angle_square += angle_error * angle_error / n;
        }
        let Deviations { length: length_deviation, angle: angle_deviation, .. } = parameters.deviations();
        // relative deviation of a standard deviation: 1 / sqrt(2 n) = 2.2 %, here within 4.5 of them
        assert!(((square - sum * sum).sqrt() / length_deviation - 1.0).abs() < 0.1);
        assert!(((angle_square - angle_sum * angle_sum).sqrt() / angle_deviation - 1.0).abs() < 0.1);
        assert!(angle_sum.abs() < 4.5 * angle_deviation / n.sqrt(), "angles have no static error");
        assert!(sum.abs() < d::SENSOR_LENGTH_BIAS + 4.5 * length_deviation / n.sqrt());
        biases.push(sum);
    }
    // uniform within +-3 mm: standard deviation 3 mm / sqrt(3)
    let deviation = (biases.iter().map(|b| b * b).sum::<f64>() / 200.0).sqrt();
    assert!((deviation / (d::SENSOR_LENGTH_BIAS / 3.0_f64.sqrt()) - 1.0).abs() < 0.15, "{deviation}");
}

#[test]
fn ideal_sensors_pass_everything_on() {
    let truth = exact(&model(), VIA, [0.1, -0.2, 0.3]);
    let mut sensors = Sensors::new(SensorParameters::default(), Xoshiro256PlusPlus::seed_from_u64(1));
    assert_eq!(sensors.read(&truth), truth);
}
