//! Poses that three motors can hold.
//!
//! Against the platform's weight three motors need voltages that grow with 1 / sigma_min. Next to a direct
//! singularity a pose error of a tenth of a millimetre can therefore lie beyond the voltage limit, and what is
//! once there sinks away. A prediction that only knows the situation of the tick does not see that edge, so
//! the fitness asks for it: the voltages that hold the pose at the horizon, linear about the reference there.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::{ReferencePoint, Situation};
use crate::dynamics::{Inputs, PlantModel, current_maps, static_load};
use crate::mechanism::{Limb, Pose};
use crate::scalar::{Scalar, constant};

/// Voltages of the leg motors that hold the predicted pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct Holding<T> {
    /// Of the pose that no acceleration leads to, V.
    voltages: Vector3<T>,
    /// V per s_ddot, held up to the horizon.
    slope: Matrix3<T>,
    /// V
    limit: T,
    /// m2/V2
    weight: T,
}

/// What holding may take, and what more of it counts in the fitness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HoldingTerm<T = f64> {
    /// Share of the voltage limit that may go into holding.
    pub usable: T,
    /// What a volt beyond it counts, squared, m2/V2.
    pub weight: T,
}

impl<T: Scalar> Default for HoldingTerm<T> {
    /// Chosen over random crossings, see `docs/control.md`.
    fn default() -> Self {
        Self { usable: constant(0.97), weight: constant(1e-6) }
    }
}

/// Step of the difference quotients, m or rad: far below the distance over which the voltages change,
/// far above rounding. Why quotients: `docs/decisions.md`.
const STEP: f64 = 1e-7;

impl<T: Scalar> Holding<T> {
    /// At `situation`, with the reference `ahead` at the horizon (s). `None` where the motors cannot even hold that,
    /// as in the midst of a crossing, and with six motors, which hold every pose within the joints' limits.
    pub fn new(
        model: &PlantModel<T>,
        situation: &Situation<T>,
        ahead: &ReferencePoint<T>,
        horizon: T,
        term: &HoldingTerm<T>,
    ) -> Option<Self> {
        if model.motors.revolute_motors {
            return None;
        }
        let limit = model.motors.v_max * term.usable;
        let target = ahead.position;
        let voltages = voltages(model, &target).filter(|v| v.iter().all(|v| v.abs() < limit))?;
        let gradient = gradient(model, &target, &voltages)?;
        let still = situation.s + situation.s_dot * horizon - target;
        Some(Self {
            voltages: voltages + gradient * still,
            slope: gradient * (horizon * horizon * constant(0.5)),
            limit,
            weight: term.weight,
        })
    }

    /// The part of the fitness, m2, for an s_ddot ((m, rad, rad)/s2) held up to the horizon.
    #[inline]
    pub fn weigh(&self, acceleration: &Vector3<T>) -> T {
        let voltages = self.voltages + self.slope * acceleration;
        let excess = voltages.map(|v| (v.abs() - self.limit).max(T::zero()));
        excess.norm_squared() * self.weight
    }
}

/// Voltages of three leg motors that hold the pose `s` (m, rad, rad), V. `None` at a direct singularity.
fn voltages<T: Scalar>(model: &PlantModel<T>, s: &Vector3<T>) -> Option<Vector3<T>> {
    let limbs = Limb::all(&model.geometry, &Pose::new(&model.geometry, s));
    let (leg_map, _) = current_maps(model, &limbs);
    let currents = leg_map.try_inverse()? * static_load(model, s, &Inputs::zero());
    Some(currents * model.motors.resistance)
}

/// Derivatives of [`voltages`] along the coordinates, V/m and V/rad, by difference quotients.
fn gradient<T: Scalar>(model: &PlantModel<T>, s: &Vector3<T>, voltages: &Vector3<T>) -> Option<Matrix3<T>> {
    let mut gradient = Matrix3::zeros();
    for k in 0..3 {
        let mut aside = *s;
        aside[k] += constant(STEP);
        let change = self::voltages(model, &aside)? - voltages;
        gradient.set_column(k, &(change / constant::<T>(STEP)));
    }
    Some(gradient)
}

#[cfg(test)]
mod tests {
    use num_dual::Dual64;
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;
    use crate::control::{CHANNELS, Estimate, Gains, Measurement};
    use crate::dynamics::PlantParameters;
    use crate::study::Crossing;

    /// Dual numbers know the derivatives exactly. Where holding takes less than the voltage limit, the quotients
    /// are off by no more than a hundredth of a per cent, in a term that is linear in the pose anyway.
    #[test]
    fn difference_quotients_are_the_exact_derivatives_to_a_hundredth_of_a_per_cent() {
        let parameters = Crossing::default().experiment(false).plant.mechanism;
        let model = PlantModel::<f64>::without_stops(&parameters);
        let dual = PlantModel::without_stops(&parameters.map(Dual64::from));
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut largest, mut poses) = (0.0_f64, 0);
        for _ in 0..200 {
            let [start, _, end] = Crossing::random(&PlantParameters::default(), &mut rng).waypoints.map(Vector3::from);
            for s in (0..=40).map(|k| start.lerp(&end, f64::from(k) / 40.0)) {
                let held = voltages(&model, &s).filter(|v| v.amax() < model.motors.v_max);
                let Some(quotients) = held.and_then(|v| gradient(&model, &s, &v)) else { continue };
                let exact = Matrix3::from_columns(&[0, 1, 2].map(|k| {
                    let along = Vector3::from_fn(|i, _| Dual64::new(s[i], f64::from(u8::from(i == k))));
                    voltages(&dual, &along).unwrap().map(|v| v.eps)
                }));
                largest = largest.max((quotients - exact).norm() / exact.norm());
                poses += 1;
            }
        }
        println!("largest relative error of the quotients: {largest:.1e}, over {poses} poses");
        assert!(poses > 4000 && largest < 1e-4, "{largest:e} {poses}");
    }

    /// On the way to the singular surface, from where the voltage to hold is 96.5 % of the limit to where it is 98.5 %.
    #[test]
    fn what_holding_takes_beyond_the_usable_voltage_counts_squared() {
        let experiment = Crossing::default().experiment(false);
        let model = PlantModel::<f64>::without_stops(&experiment.plant.mechanism);
        let [start, via, _] = experiment.controller.waypoints.map(Vector3::from);
        let v_max = model.motors.v_max;
        let way = |wanted: f64| {
            let (mut held, mut lost) = (0.0, 1.0);
            for _ in 0..60 {
                let middle = 0.5 * (held + lost);
                let held_there = voltages(&model, &start.lerp(&via, middle)).is_some_and(|v| v.amax() < wanted * v_max);
                if held_there { held = middle } else { lost = middle }
            }
            held
        };
        let (target, beyond) = (start.lerp(&via, way(0.965)), start.lerp(&via, way(0.985)));
        let (step, horizon, term) = (beyond - target, 0.01, HoldingTerm::default());

        let reference = |position| ReferencePoint { position, ..ReferencePoint::default() };
        let estimate = Estimate { s: target, s_dot: step * (0.5 / horizon) };
        let measured = Measurement::from_array(&[0.0; CHANNELS]);
        let situation = Situation::new(&model, &estimate, &reference(target), &measured, &Gains::default());
        let holding = |ahead| Holding::new(&model, &situation, &reference(ahead), horizon, &term);
        // velocity leads half the step, the accelerations as far on or back
        for (share, counts) in [(1.0, true), (0.0, true), (-1.0, false)] {
            let acceleration = step * (share / (horizon * horizon));
            let held = voltages(&model, &(target + step * (0.5 * (1.0 + share)))).unwrap();
            let excess = held.map(|v| (v.abs() - term.usable * v_max).max(0.0));
            let (expected, found) =
                (term.weight * excess.norm_squared(), holding(target).unwrap().weigh(&acceleration));
            // linear in the pose, which 1 / sigma_min is not: a hundredth of the voltage's change
            assert!((found - expected).abs() <= 0.1 * expected, "{found:e} {expected:e}");
            assert_eq!(expected > 0.0, counts);
        }
        assert!(holding(beyond).is_none(), "what cannot be held anyway does not count");
    }
}
