//! Measures on request: one JSON request a line on standard input, one JSON answer a line on standard
//! output. Who asks, `benches/suite`, alternates between this program and those it is compared with.

mod argmin_problem;
mod calls;
mod crossing;
mod dynamics;
mod fmu;
mod growth;
mod pair;
mod searches;
mod tick;
mod work_precision;

use std::io::{BufRead, Write};
use std::time::Instant;

use serde::Deserialize;
use serde_json::{Value, json};

use searches::{Budget, Optimizer};

/// What can be asked; times are seconds an operation, or of each of a row of them.
#[derive(Deserialize)]
#[serde(tag = "measure", rename_all = "snake_case", deny_unknown_fields)]
enum Request {
    /// The right-hand side at these states.
    RightHandSide { states: Vec<[f64; 12]>, rounds: usize },
    /// The solver over each communication step of the crossing with its voltages.
    SolverStep { step: f64, tolerance: f64 },
    /// A step of the plant's FMU over the same: seconds in `fmi2DoStep` alone.
    PlantStep { plant: String, step: f64, tolerance: f64 },
    /// `fmi2GetReal`, `fmi2SetReal` and an empty `fmi2DoStep` of an FMU.
    Calls { library: String, guid: String, get: Vec<u32>, set: Vec<u32>, step: f64, rounds: usize },
    /// Plant and controller without FMI, s a tick; `mode` is the controller's `control_mode`.
    PairNative { mode: i32, ticks: usize },
    /// The same through the C functions of the shared libraries, with what each part takes.
    PairLibraries { plant: String, controller: String, mode: i32, ticks: usize },
    /// The same through the crate `fmi`.
    PairFmiCrate { plant: String, controller: String, mode: i32, ticks: usize },
    /// So many instances of both FMUs in this process, stepped in turn by `threads` threads.
    Instances { plant: String, controller: String, count: usize, threads: usize },
    /// The native pair for so many simulated minutes: seconds a tick and resident bytes, a minute each.
    Hours { minutes: usize },
    /// A controller tick with a swarm of this size and so many iterations.
    Tick { swarm_size: usize, iterations: usize },
    /// Where the time of a controller tick with the default swarm goes.
    TickParts { revolute_motors: bool },
    /// Seconds of a swarm's search, ours or another's.
    Search { optimizer: Optimizer, members: usize, budget: Budget, rounds: usize },
    /// Error, right-hand sides and time of each integrator at each tolerance.
    WorkPrecision { rounds: usize },
}

fn answer(request: Request) -> anyhow::Result<Value> {
    Ok(match request {
        Request::RightHandSide { states, rounds } => json!(dynamics::right_hand_side(&states, rounds)),
        Request::SolverStep { step, tolerance } => dynamics::solver_step(step, tolerance)?,
        Request::PlantStep { plant, step, tolerance } => json!(calls::plant_step(&plant, step, tolerance)?),
        Request::Calls { library, guid, get, set, step, rounds } => {
            calls::calls(&library, &guid, &get, &set, step, rounds)?
        }
        Request::PairNative { mode, ticks } => json!(pair::native(mode, ticks)?),
        Request::PairLibraries { plant, controller, mode, ticks } => pair::libraries(&plant, &controller, mode, ticks)?,
        Request::PairFmiCrate { plant, controller, mode, ticks } => {
            json!(pair::fmi_crate(&plant, &controller, mode, ticks)?)
        }
        Request::Instances { plant, controller, count, threads } => {
            growth::instances(&plant, &controller, count, threads)?
        }
        Request::Hours { minutes } => growth::long_run(minutes)?,
        Request::Tick { swarm_size, iterations } => json!(tick::ticks(swarm_size, iterations)?),
        Request::TickParts { revolute_motors } => tick::parts(revolute_motors)?,
        Request::Search { optimizer, members, budget, rounds } => {
            json!(searches::search(optimizer, members, budget, rounds)?)
        }
        Request::WorkPrecision { rounds } => json!(work_precision::table(rounds)?),
    })
}

/// Seconds of `work`, and what it gives.
fn timed<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let begin = Instant::now();
    let result = std::hint::black_box(work());
    (begin.elapsed().as_secs_f64(), result)
}

/// Seconds of `work`.
fn seconds(work: impl FnOnce()) -> f64 {
    timed(work).0
}

fn main() -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        serde_json::to_writer(&mut out, &answer(serde_json::from_str(&line?)?)?)?;
        writeln!(out)?;
        out.flush()?;
    }
    Ok(())
}
