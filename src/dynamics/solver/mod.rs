//! An explicit embedded Runge-Kutta method with error control: DOP853, of order 8, by Dormand,
//! Prince and Hairer.
//!
//! Hairer, E., Nørsett, S. P., Wanner, G.: Solving Ordinary Differential Equations I, second edition
//! (1993), section II.5. Works in place, without allocation; what persists between calls is the step
//! size alone. Why this method: docs/performance.md.

mod coefficients;

use nalgebra::SVector;
use serde::{Deserialize, Serialize};

use self::coefficients::{A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, B, C, ERROR_3, ERROR_5};

/// Accuracy and limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings<const N: usize> {
    /// Largest local error a step, relative to max(|x_i|, `nominal[i]`).
    pub tolerance: f64,
    /// Magnitude below which a component's error counts as absolute.
    pub nominal: [f64; N],
    /// Largest step, s.
    pub max_step: f64,
}

/// Why an integration stopped early.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SolverError {
    #[error("the solver's step fell below {step:e} s at {time} s: the solution diverges or is not smooth")]
    StepTooSmall { time: f64, step: f64 },
    #[error("the solver gave up at {time} s after {steps} steps")]
    TooManySteps { time: f64, steps: u64 },
}

/// The method's memory between calls.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Solver {
    /// Step that the last error estimate allows, s; 0 before the first call.
    step: f64,
    /// Right-hand sides evaluated so far.
    pub evaluations: u64,
}

/// The first step's length as a fraction of the tolerance's eighth root: a cautious start.
const FIRST_STEP: f64 = 1e-3;
/// Steps of one call: some seconds of work, after which the caller deserves an answer. The default
/// plant, whose motors hold the step below 3 ms, takes 40 000 for 100 s.
pub const MOST_STEPS: u64 = 1_000_000;
const SAFETY: f64 = 0.9;
/// Largest change of the step, down and up.
const SHRINK: f64 = 0.2;
const GROW: f64 = 5.0;

impl Solver {
    /// Integrates x_dot = f(t, x) from `from` to `to` > `from` (s) in place.
    ///
    /// # Errors
    /// When the step becomes too small (the solution diverges) or too many steps are needed; `x` is
    /// then the last accepted state.
    pub fn integrate<const N: usize>(
        &mut self,
        f: impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
        x: &mut SVector<f64, N>,
        from: f64,
        to: f64,
        settings: &Settings<N>,
    ) -> Result<(), SolverError> {
        // offsets from `from`, so that a late start time costs no digits of the step
        let span = to - from;
        let mut t = 0.0;
        let mut steps = 0;
        let mut step = if self.step > 0.0 { self.step } else { FIRST_STEP * eighth_root(settings.tolerance).min(1.0) };
        let mut k1 = f(from, x);
        self.evaluations += 1;
        while t < span {
            let remaining = span - t;
            let wanted = step.min(settings.max_step);
            // no tiny last step: take the rest whole or halve it
            let h = if wanted >= 0.99 * remaining {
                remaining
            } else if wanted > 0.5 * remaining {
                0.5 * remaining
            } else {
                wanted
            };
            let (next, error) = attempt(&f, x, &k1, from + t, h, settings);
            self.evaluations += 11;
            steps += 1;
            let factor = if error.is_finite() { (SAFETY / eighth_root(error)).clamp(SHRINK, GROW) } else { SHRINK };
            if error <= 1.0 {
                t = if h == remaining { span } else { t + h };
                *x = next;
                if t < span {
                    k1 = f(from + t, x);
                    self.evaluations += 1;
                }
                // a step cut short by the end of the interval says nothing against a longer one
                step = if h < wanted { wanted.max(h * factor) } else { h * factor };
            } else {
                step = h * factor.min(1.0);
                if step < 1e-14 * (1.0 + from.abs()) {
                    return Err(SolverError::StepTooSmall { time: from + t, step });
                }
            }
            if steps > MOST_STEPS {
                return Err(SolverError::TooManySteps { time: from + t, steps });
            }
        }
        self.step = step;
        Ok(())
    }
}

/// One step of length `h`: the new state and the scaled error estimate.
#[inline]
fn attempt<const N: usize>(
    f: &impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
    x: &SVector<f64, N>,
    k1: &SVector<f64, N>,
    t: f64,
    h: f64,
    settings: &Settings<N>,
) -> (SVector<f64, N>, f64) {
    let k2 = f(t + C[0] * h, &combine(x, h, A2, [k1]));
    let k3 = f(t + C[1] * h, &combine(x, h, A3, [k1, &k2]));
    let k4 = f(t + C[2] * h, &combine(x, h, A4, [k1, &k3]));
    let k5 = f(t + C[3] * h, &combine(x, h, A5, [k1, &k3, &k4]));
    let k6 = f(t + C[4] * h, &combine(x, h, A6, [k1, &k4, &k5]));
    let k7 = f(t + C[5] * h, &combine(x, h, A7, [k1, &k4, &k5, &k6]));
    let k8 = f(t + C[6] * h, &combine(x, h, A8, [k1, &k4, &k5, &k6, &k7]));
    let k9 = f(t + C[7] * h, &combine(x, h, A9, [k1, &k4, &k5, &k6, &k7, &k8]));
    let k10 = f(t + C[8] * h, &combine(x, h, A10, [k1, &k4, &k5, &k6, &k7, &k8, &k9]));
    let k11 = f(t + C[9] * h, &combine(x, h, A11, [k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10]));
    let k12 = f(t + C[10] * h, &combine(x, h, A12, [k1, &k4, &k5, &k6, &k7, &k8, &k9, &k10, &k11]));
    let k = [k1, &k6, &k7, &k8, &k9, &k10, &k11, &k12];
    let next = combine(x, h, B, k);
    let norm = |weights| {
        let estimate = combine(&SVector::zeros(), h, weights, k);
        let mut norm: f64 = 0.0;
        for i in 0..N {
            let scale = settings.tolerance * settings.nominal[i].max(x[i].abs()).max(next[i].abs());
            let ratio = estimate[i].abs() / scale;
            // f64::max would swallow a NaN
            if ratio.is_nan() {
                return f64::NAN;
            }
            norm = norm.max(ratio);
        }
        norm
    };
    // Hairer's combination of two estimates, which behaves like one of order 7
    let (fifth, third) = (norm(ERROR_5), norm(ERROR_3));
    let error = if fifth == 0.0 { 0.0 } else { fifth * fifth / (fifth * fifth + 0.01 * third * third).sqrt() };
    (next, error)
}

/// x + h sum(weights[j] k[j])
#[inline]
fn combine<const N: usize, const S: usize>(
    x: &SVector<f64, N>,
    h: f64,
    weights: [f64; S],
    k: [&SVector<f64, N>; S],
) -> SVector<f64, N> {
    SVector::from_fn(|i, _| {
        let mut sum = 0.0;
        for j in 0..S {
            sum += weights[j] * k[j][i];
        }
        x[i] + h * sum
    })
}

/// By square roots, which are the same bits everywhere.
fn eighth_root(x: f64) -> f64 {
    x.sqrt().sqrt().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn oscillator_error(tolerance: f64) -> f64 {
        let settings = Settings { tolerance, nominal: [1.0, 1.0], max_step: f64::INFINITY };
        let mut x = SVector::from([1.0, 0.0]);
        Solver::default().integrate(|_, x| SVector::from([x[1], -x[0]]), &mut x, 3.0, 13.0, &settings).unwrap();
        (x - SVector::from([10.0_f64.cos(), -(10.0_f64.sin())])).amax()
    }

    #[test]
    fn harmonic_oscillator_is_as_accurate_as_asked() {
        for tolerance in [1e-4, 1e-6, 1e-9, 1e-12] {
            let error = oscillator_error(tolerance);
            // local errors of some dozen steps add up
            assert!(error < 50.0 * tolerance, "{error:e} at {tolerance:e}");
        }
    }

    #[test]
    fn the_method_is_of_eighth_order() {
        // the error of one step grows with h^9
        let settings = Settings { tolerance: 1e30, nominal: [1.0], max_step: f64::INFINITY };
        let error = |h: f64| {
            // an ordinary point: at t = 0 the leading error terms cancel
            let t = 0.9;
            let exact = |t: f64| (0.5 * (2.0 * t).sin()).exp();
            let x = SVector::from([exact(t)]);
            let f = |t: f64, x: &SVector<f64, 1>| SVector::from([x[0] * (2.0 * t).cos()]);
            let (next, _) = attempt(&f, &x, &f(t, &x), t, h, &settings);
            (next[0] - exact(t + h)).abs()
        };
        let order = (error(0.4) / error(0.2)).log2();
        assert!((8.5..9.5).contains(&order), "{order}");
    }

    #[test]
    fn a_solution_that_blows_up_is_an_error_and_not_a_hang() {
        let settings = Settings { tolerance: 1e-6, nominal: [1.0], max_step: 1.0 };
        let mut x = SVector::from([1.0]);
        // x = 1 / (1 - t)
        let outcome = Solver::default().integrate(|_, x| SVector::from([x[0] * x[0]]), &mut x, 0.0, 2.0, &settings);
        assert!(matches!(outcome, Err(SolverError::StepTooSmall { .. } | SolverError::TooManySteps { .. })));
    }
}
