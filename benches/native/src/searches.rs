//! What a swarm costs beside the evaluations of its objective, in the size that the controller uses. The objective is
//! a sum of squares, next to nothing. argmin's `ParticleSwarm` solves the same with as many evaluations and the
//! same family of generators, with positions in vectors, as its guide does it, or in arrays.

use std::hint::black_box;

use anyhow::{Result, bail};
use argmin::core::{Executor, PopulationState, Solver, SyncAlias};
use argmin::solver::particleswarm::{Particle, ParticleSwarm};
use argmin_math::{ArgminMul, ArgminRandom, ArgminSub, ArgminZeroLike};
use rand_xoshiro::rand_core::SeedableRng as _;
use rand_xoshiro_0_7::Xoshiro256PlusPlus as Generator;
use rand_xoshiro_0_7::rand_core::SeedableRng as _;
use rps3::control::mpso::{Bounds, Selection, Settings, Swarm};
use serde::Deserialize;

use crate::argmin_problem::{Bowl, Point, bowl};
use crate::timed;

const LOWER: f64 = -1.0;
const UPPER: f64 = 1.5;

/// Whose search.
#[derive(Deserialize, Clone, Copy)]
#[serde(rename_all = "snake_case")]
pub enum Optimizer {
    /// Ours.
    Mpso,
    /// Ours without the paper's modifications.
    Plain,
    /// argmin's over arrays, which do not allocate.
    ArgminArrays,
    /// argmin's over vectors.
    ArgminVectors,
}

/// How far a search goes: none ends early.
#[derive(Deserialize, Clone, Copy)]
pub struct Budget {
    pub swarm_size: usize,
    pub iterations: usize,
}

/// Seconds a search in 2 or 3 members, the mean of `rounds`.
pub fn search(optimizer: Optimizer, members: usize, budget: Budget, rounds: usize) -> Result<f64> {
    match members {
        2 => in_members::<2>(optimizer, budget, rounds),
        3 => in_members::<3>(optimizer, budget, rounds),
        _ => bail!("a search has 2 or 3 members, not {members}"),
    }
}

fn in_members<const D: usize>(optimizer: Optimizer, budget: Budget, rounds: usize) -> Result<f64> {
    match optimizer {
        Optimizer::Mpso => ours::<D>(Selection::Ranked, budget, rounds),
        Optimizer::Plain => ours::<D>(Selection::Plain, budget, rounds),
        Optimizer::ArgminArrays => argmin(Point([LOWER; D]), Point([UPPER; D]), budget, rounds),
        Optimizer::ArgminVectors => argmin(vec![LOWER; D], vec![UPPER; D], budget, rounds),
    }
}

fn ours<const D: usize>(selection: Selection, budget: Budget, rounds: usize) -> Result<f64> {
    let settings = Settings {
        swarm_size: budget.swarm_size,
        max_iterations: budget.iterations,
        stall_iterations: budget.iterations,
        selection,
        ..Settings::default()
    };
    let mut swarm = Swarm::new(Bounds::new([LOWER; D], [UPPER; D])?, settings)?;
    let mut rng = rand_xoshiro::Xoshiro256PlusPlus::seed_from_u64(1);
    mean(rounds, || {
        black_box(swarm.minimize(&mut rng, &[], |x| bowl(x)));
        Ok(())
    })
}

fn argmin<P>(lower: P, upper: P, budget: Budget, rounds: usize) -> Result<f64>
where
    P: Clone + SyncAlias + ArgminSub<P, P> + ArgminMul<f64, P> + ArgminRandom + ArgminZeroLike,
    for<'a> ParticleSwarm<P, f64, &'a mut Generator>: Solver<Bowl<P>, PopulationState<Particle<P, f64>, f64>>,
{
    let mut rng = Generator::seed_from_u64(1);
    mean(rounds, || {
        let range = (lower.clone(), upper.clone());
        let solver = ParticleSwarm::new(range, budget.swarm_size).with_rng_generator(&mut rng);
        let search = Executor::new(Bowl::default(), solver);
        black_box(search.configure(|state| state.max_iters(budget.iterations as u64)).run()?);
        Ok(())
    })
}

/// Seconds of `work`, the mean of `rounds`.
fn mean(rounds: usize, mut work: impl FnMut() -> Result<()>) -> Result<f64> {
    let (elapsed, outcome) = timed(|| (0..rounds).try_for_each(|_| work()));
    outcome.map(|()| elapsed / rounds as f64)
}
