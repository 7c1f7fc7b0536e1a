//! How the swarm's search converges within a tick, over the ticks of the default crossing in mode 4, as CSV:
//! `cargo run --release --example convergence`. `cargo xtask demo` draws it.
//!
//! The best fitness after each iteration is taken in proportion to that at the search's end.

use std::io::{BufWriter, Write};

use rps3::control::{Controller, ReferencePoint};
use rps3::coupling::Experiment;
use rps3::study::Crossing;

/// Best fitness of a search after 0, 1, ... iterations, m2.
type Search = Vec<f64>;

fn main() -> anyhow::Result<()> {
    let mut out = BufWriter::new(std::io::stdout().lock());
    writeln!(out, "motors,iteration,searching,within_1_percent,median_ratio,ninety_ratio,ninety_nine_ratio")?;
    for (motors, revolute_motors) in [(6, true), (3, false)] {
        let experiment = Crossing::default().experiment(revolute_motors);
        let searches = searches(&experiment)?;
        let count = searches.len() as f64;
        for iteration in 0..=experiment.controller.swarm.settings.max_iterations {
            let searching = searches.iter().filter(|search| search.len() > iteration).count() as f64 / count;
            let mut ratios: Vec<f64> = searches.iter().map(|search| ratio(search, iteration)).collect();
            ratios.sort_unstable_by(f64::total_cmp);
            let within = ratios.iter().filter(|ratio| **ratio < 1.01).count() as f64 / count;
            let quantile = |share: f64| ratios[(share * (count - 1.0)) as usize];
            write!(out, "{motors},{iteration},{searching:.4},{within:.4}")?;
            writeln!(out, ",{:.6},{:.6},{:.6}", quantile(0.5), quantile(0.9), quantile(0.99))?;
        }
    }
    Ok(out.flush()?)
}

/// Best fitness of `search` after `iteration` iterations, or those it made, over the last; 1 where both are 0.
fn ratio(search: &Search, iteration: usize) -> f64 {
    let last = search.len() - 1;
    if search[last] > 0.0 { search[iteration.min(last)] / search[last] } else { 1.0 }
}

/// The searches of a run, one a tick.
fn searches(experiment: &Experiment) -> anyhow::Result<Vec<Search>> {
    let mut controller = Controller::new(experiment.controller)?;
    let external = ReferencePoint::default();
    let mut searches = Vec::new();
    experiment.run_with(
        |t, measured| {
            let mut search = Search::new();
            let observer = |progress: &rps3::control::mpso::Progress| search.push(progress.best_value);
            let outcome = controller.tick_observed(t, measured, &external, &experiment.tuning, true, observer);
            searches.push(search);
            outcome
        },
        |_| {},
    )?;
    Ok(searches)
}
