//! The swarm as section 3 of the paper defines it, fact by fact.

use proptest::prelude::*;
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use rps3::control::mpso::{Bounds, DecaySchedule, Selection, Settings, SettingsError, Solution, Swarm, inertia};

mod mpso_functions;
use mpso_functions::{MULTIMODAL, RASTRIGIN, SPHERE};

fn swarm<const D: usize>(lower: f64, upper: f64, settings: Settings) -> Swarm<D> {
    Swarm::new(Bounds::new([lower; D], [upper; D]).unwrap(), settings).unwrap()
}

fn generator(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

/// Settings that use their whole budget.
fn unstalled(max_iterations: usize) -> Settings {
    Settings { max_iterations, stall_iterations: max_iterations, ..Settings::default() }
}

#[test]
fn inertia_falls_linearly_from_max_to_min() {
    // (3.2) with iter_max = 10: 0.9 - 0.05 iter.
    let settings = unstalled(10);
    for (iteration, expected) in [(0, 0.9), (1, 0.85), (5, 0.65), (9, 0.45), (10, 0.4)] {
        assert!((inertia(&settings, iteration) - expected).abs() < 1e-15);
    }
}

#[test]
fn decay_scale_steps_down_only_without_progress_and_stops_at_its_floor() {
    // (3.5) by hand: step = 1.25 (0.7 - 0.005) / 10 = 0.086875.
    let mut decay = DecaySchedule::new(&unstalled(10));
    let improved = [false, true, false, false, true, false, false, false, false, false, false];
    let expected = [0.613125, 0.613125, 0.52625, 0.439375, 0.439375, 0.3525, 0.265625, 0.17875, 0.091875, 0.005, 0.005];
    assert_eq!(decay.scale(), 0.7);
    for (improved, expected) in improved.into_iter().zip(expected) {
        decay.advance(improved);
        assert!((decay.scale() - expected).abs() < 1e-15, "{} is not {expected}", decay.scale());
    }
}

#[test]
fn each_iteration_follows_the_schedule_and_the_best_never_worsens() {
    let settings = unstalled(60);
    let mut by_hand = DecaySchedule::new(&settings);
    let mut last: Option<f64> = None;
    swarm::<3>(RASTRIGIN.lower, RASTRIGIN.upper, settings).minimize_observed(
        &mut generator(7),
        &[],
        |x| (RASTRIGIN.value)(x),
        |progress| {
            if let Some(last) = last {
                assert!(progress.best_value <= last);
                by_hand.advance(progress.best_value < last);
            }
            assert_eq!(progress.decay_scale, by_hand.scale());
            last = Some(progress.best_value);
        },
    );
}

#[test]
fn a_smooth_bowl_is_solved_in_every_dimension() {
    fn solve<const D: usize>(selection: Selection) {
        let settings = Settings { selection, ..unstalled(300) };
        let mut swarm = swarm::<D>(SPHERE.lower, SPHERE.upper, settings);
        for seed in 0..20 {
            let solution = swarm.minimize(&mut generator(seed), &[], |x| (SPHERE.value)(x));
            // A thousandth of the range from the minimum in each member.
            assert!(solution.value < D as f64 * 0.015 * 0.015, "{D} members, {selection:?}, seed {seed}: {solution:?}");
        }
    }
    for selection in [Selection::Plain, Selection::Ranked] {
        solve::<1>(selection);
        solve::<2>(selection);
        solve::<3>(selection);
        solve::<6>(selection);
    }
}

#[test]
fn an_optimum_on_the_edge_of_the_box_is_hit_exactly() {
    let settings = unstalled(100);
    let solution = swarm::<2>(-1.0, 2.0, settings).minimize(&mut generator(3), &[], |x| x[0] - x[1]);
    assert_eq!(solution.position, [-1.0, 2.0]);
}

#[test]
fn the_first_stopping_criterion_counts_iterations() {
    let solution = swarm::<2>(-1.0, 1.0, unstalled(17)).minimize(&mut generator(1), &[], |x| x[0]);
    assert_eq!((solution.iterations, solution.evaluations), (17, 20 * 18));
}

#[test]
fn the_second_stopping_criterion_counts_iterations_without_improvement() {
    let settings = Settings { stall_iterations: 5, ..Settings::default() };
    let flat = swarm::<2>(-1.0, 1.0, settings).minimize(&mut generator(1), &[], |_| 1.0);
    assert_eq!(flat.iterations, 5);

    // One improvement, in iteration 3, restarts the count.
    let mut evaluations = 0;
    let once = swarm::<2>(-1.0, 1.0, settings).minimize(&mut generator(1), &[], |_| {
        evaluations += 1;
        if evaluations == 20 + 2 * 20 + 5 { 0.0 } else { 1.0 }
    });
    assert_eq!((once.iterations, once.evaluations, evaluations), (8, 180, 180));
}

#[test]
fn a_warm_start_is_evaluated_first_and_never_lost() {
    let mut swarm = swarm::<3>(-5.0, 5.0, Settings::default());
    let start = [0.1, 0.7, -0.3];
    let needle = |x: &[f64; 3]| if *x == start { -1.0 } else { x.iter().map(|x| x * x).sum() };
    let solution = swarm.minimize(&mut generator(1), &[start], needle);
    assert_eq!((solution.position, solution.value), (start, -1.0));

    let mut first = None;
    swarm.minimize(&mut generator(1), &[[9.0, -9.0, 1.0]], |x| {
        first.get_or_insert(*x);
        0.0
    });
    assert_eq!(first, Some([5.0, -5.0, 1.0]), "a start outside is moved to the box");

    let without = swarm.minimize(&mut generator(4), &[], |x| x[0]);
    let undefined = swarm.minimize(&mut generator(4), &[[f64::NAN, 0.0, 0.0]], |x| x[0]);
    assert_eq!(without, undefined);
}

#[test]
fn values_that_are_not_finite_count_as_worst() {
    // A bowl of which all but a fifth is missing.
    let holed = |x: &[f64; 2]| match x[0] {
        a if a < 0.0 => f64::NAN,
        a if a > 3.0 => f64::NEG_INFINITY,
        a if a > 2.0 => f64::INFINITY,
        a => (a - 1.0) * (a - 1.0) + x[1] * x[1],
    };
    let solution = swarm::<2>(-5.0, 5.0, unstalled(200)).minimize(&mut generator(1), &[], holed);
    assert!(solution.position.iter().all(|x| x.is_finite()));
    assert!(solution.value.is_finite() && solution.value < 1e-3, "{solution:?}");

    let nowhere = swarm::<2>(-5.0, 5.0, Settings::default()).minimize(&mut generator(1), &[[1.0, 2.0]], |_| f64::NAN);
    assert_eq!((nowhere.position, nowhere.value), ([1.0, 2.0], f64::INFINITY));
}

#[test]
fn a_member_with_equal_bounds_stays_where_it_is() {
    let bounds = Bounds::new([-1.0, 0.25], [1.0, 0.25]).unwrap();
    let mut swarm = Swarm::new(bounds, unstalled(100)).unwrap();
    let solution = swarm.minimize(&mut generator(1), &[], |x| {
        assert_eq!(x[1], 0.25);
        x[0] * x[0]
    });
    assert!(solution.value < 1e-6);
}

#[test]
fn distance_plays_a_part_by_its_decay_scale_and_errors_by_their_order_alone() {
    let search = |decay: f64, unit: f64| {
        let settings = Settings { decay_max: decay, decay_min: decay, ..unstalled(30) };
        let mut visited = Vec::new();
        swarm::<2>(RASTRIGIN.lower, RASTRIGIN.upper, settings).minimize(&mut generator(2), &[], |x| {
            visited.push(*x);
            unit * (RASTRIGIN.value)(x)
        });
        visited
    };
    // Error ranks differ by one, distance ranks by at most 39: below 1 / 39 distance overrules no error.
    assert_eq!(search(0.0, 1.0), search(0.02, 1.0));
    assert_eq!(search(0.0, 1.0), search(0.0, 1024.0));
    assert_ne!(search(0.02, 1.0), search(0.7, 1.0));
    assert_eq!(search(0.7, 1.0), search(0.7, 1024.0), "ranks see the order of errors, not their size");
}

/// Every bit of a solution.
fn bits<const D: usize>(solution: &Solution<D>) -> Vec<u64> {
    let counts = [solution.iterations as u64, solution.evaluations as u64, solution.value.to_bits()];
    solution.position.iter().map(|x| x.to_bits()).chain(counts).collect()
}

#[test]
fn searches_leave_nothing_behind_but_the_generator() {
    let mut used = swarm::<3>(RASTRIGIN.lower, RASTRIGIN.upper, Settings::default());
    let mut rng = generator(11);
    for _ in 0..5 {
        used.minimize(&mut rng, &[], |x| (RASTRIGIN.value)(x));
    }
    // Continue after a snapshot of the generator with a new swarm.
    let snapshot = postcard::to_stdvec(&rng).unwrap();
    let mut restored: Xoshiro256PlusPlus = postcard::from_bytes(&snapshot).unwrap();
    let mut fresh = swarm::<3>(RASTRIGIN.lower, RASTRIGIN.upper, Settings::default());
    for _ in 0..5 {
        let a = used.minimize(&mut rng, &[], |x| (RASTRIGIN.value)(x));
        let b = fresh.minimize(&mut restored, &[], |x| (RASTRIGIN.value)(x));
        assert_eq!(bits(&a), bits(&b));
    }
    assert_eq!(rng.next_u64(), restored.next_u64());
}

#[test]
fn settings_survive_serialization() {
    let settings = Settings { velocity_limit: 0.1, selection: Selection::Plain, ..Settings::default() };
    assert_eq!(postcard::from_bytes::<Settings>(&postcard::to_stdvec(&settings).unwrap()).unwrap(), settings);
}

#[test]
fn impossible_settings_are_refused() {
    let ok = Settings::default();
    assert_eq!(ok.check(), Ok(()));
    let refused = [
        Settings { swarm_size: 1, ..ok },
        Settings { swarm_size: Settings::MAX_SWARM_SIZE + 1, ..ok },
        Settings { max_iterations: 0, ..ok },
        Settings { stall_iterations: 0, ..ok },
        Settings { c1: -0.1, ..ok },
        Settings { c2: f64::INFINITY, ..ok },
        Settings { inertia_min: 0.95, ..ok },
        Settings { inertia_max: f64::NAN, ..ok },
        Settings { decay_min: -0.1, ..ok },
        Settings { decay_max: 0.001, ..ok },
        Settings { regulating_scale: f64::NAN, ..ok },
        Settings { velocity_limit: 0.0, ..ok },
        Settings { velocity_limit: 1.1, ..ok },
    ];
    let bounds = Bounds::new([0.0], [1.0]).unwrap();
    for settings in refused {
        assert!(Swarm::new(bounds, settings).is_err(), "{settings:?}");
    }
    for (lower, upper) in [(1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-f64::MAX, f64::MAX)] {
        let refusal = Bounds::new([0.0, lower], [1.0, upper]);
        assert!(matches!(refusal, Err(SettingsError::Bounds { member: 1, .. })), "{lower} to {upper}");
    }
}

prop_compose! {
    fn any_settings()(
        swarm_size in 2..40_usize,
        max_iterations in 1..40_usize,
        stall_iterations in 1..40_usize,
        c in (0.0..4.0, 0.0..4.0),
        inertia in (0.0..1.0, 0.0..1.0),
        decay in (0.0..2.0, 0.0..2.0),
        regulating_scale in 0.0..5.0,
        velocity_limit in 0.001..1.0,
        plain: bool,
    ) -> Settings {
        let sorted = |(a, b): (f64, f64)| if a < b { (a, b) } else { (b, a) };
        let ((inertia_min, inertia_max), (decay_min, decay_max)) = (sorted(inertia), sorted(decay));
        let selection = if plain { Selection::Plain } else { Selection::Ranked };
        Settings {
            swarm_size, max_iterations, stall_iterations, c1: c.0, c2: c.1, inertia_max, inertia_min, decay_max,
            decay_min, regulating_scale, velocity_limit, selection,
        }
    }
}

proptest! {
    #[test]
    fn any_search_stays_in_the_box_and_returns_the_best_it_saw(
        settings in any_settings(),
        seed: u64,
        lower in prop::array::uniform3(-1e3..1e3),
        width in prop::array::uniform3(0.0..1e3),
        function in 0..3_usize,
    ) {
        let upper = std::array::from_fn(|g| lower[g] + width[g]);
        let bounds = Bounds::new(lower, upper).unwrap();
        let (mut evaluations, mut smallest) = (0, f64::INFINITY);
        let mut previous = f64::INFINITY;
        let solution = Swarm::new(bounds, settings).unwrap().minimize_observed(
            &mut generator(seed),
            &[],
            |x| {
                for g in 0..3 {
                    assert!(lower[g] <= x[g] && x[g] <= upper[g], "{x:?} is outside");
                }
                let value = (MULTIMODAL[function].value)(x);
                evaluations += 1;
                smallest = value.min(smallest);
                value
            },
            |progress| {
                assert!(progress.best_value <= previous);
                previous = progress.best_value;
            },
        );
        prop_assert_eq!(solution.value, smallest);
        prop_assert_eq!((MULTIMODAL[function].value)(&solution.position), solution.value);
        prop_assert_eq!(solution.evaluations, evaluations);
        prop_assert_eq!(evaluations, settings.swarm_size * (1 + solution.iterations));
        prop_assert!(solution.iterations <= settings.max_iterations);
    }
}
