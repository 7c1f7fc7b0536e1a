//! What a swarm costs beside the evaluations of its objective, in the size the controller uses:
//! 20 individuals, 30 iterations, 2 and 3 members. The objective is a sum of squares, next to
//! nothing. argmin's `ParticleSwarm` solves the same with the same number of evaluations, the same
//! family of generators and positions in vectors, as its guide does it, or in arrays.
//! `pyswarms_baseline.py` beside this file does the same for pyswarms.
//!
//! ```sh
//! cargo bench --bench mpso
//! ```

use argmin::core::Executor;
use argmin::solver::particleswarm::ParticleSwarm;
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rand_xoshiro::rand_core::SeedableRng;
use rps3::control::mpso::{Bounds, Selection, Settings, Swarm};

mod argmin_problem;
use argmin_problem::{ArrayBowl, Bowl, Point};

const SIZE: usize = 20;
const ITERATIONS: usize = 30;
const LOWER: f64 = -1.0;
const UPPER: f64 = 1.5;

fn swarms<const D: usize>(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group(format!("swarm, {D} members"));
    group.throughput(Throughput::Elements((SIZE * (1 + ITERATIONS)) as u64));

    let bounds = Bounds::new([LOWER; D], [UPPER; D]).expect("the bounds are finite");
    for (name, selection) in [("mpso", Selection::Ranked), ("plain", Selection::Plain)] {
        let settings = Settings {
            swarm_size: SIZE,
            max_iterations: ITERATIONS,
            stall_iterations: ITERATIONS,
            selection,
            ..Settings::default()
        };
        let mut swarm = Swarm::new(bounds, settings).expect("the settings are within their ranges");
        let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
        group.bench_function(name, |bencher| {
            bencher.iter(|| swarm.minimize(&mut rng, &[], |x| argmin_problem::bowl(x)));
        });
    }

    use rand_xoshiro_0_7::rand_core::SeedableRng as _;
    let mut rng = rand_xoshiro_0_7::Xoshiro256PlusPlus::seed_from_u64(1);
    group.bench_function("argmin, arrays", |bencher| {
        bencher.iter(|| {
            let range = (Point([LOWER; D]), Point([UPPER; D]));
            let solver = ParticleSwarm::new(range, SIZE).with_rng_generator(&mut rng);
            Executor::new(ArrayBowl, solver)
                .configure(|state| state.max_iters(ITERATIONS as u64))
                .run()
                .map(|result| result.state.best_cost)
                .ok()
        });
    });
    group.bench_function("argmin, vectors", |bencher| {
        bencher.iter(|| {
            let range = (vec![LOWER; D], vec![UPPER; D]);
            let solver = ParticleSwarm::new(range, SIZE).with_rng_generator(&mut rng);
            Executor::new(Bowl, solver)
                .configure(|state| state.max_iters(ITERATIONS as u64))
                .run()
                .map(|result| result.state.best_cost)
                .ok()
        });
    });
    group.finish();
}

criterion_group!(benches, swarms::<2>, swarms::<3>);
criterion_main!(benches);
