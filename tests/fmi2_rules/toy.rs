//! A damped oscillator with a sampled input: the smallest model that uses every part of the layer.
//!
//! x' = v, v' = -k x - c v + u; `held` is u sampled every [`PERIOD`] from the start time on. The
//! Integer `trouble` makes it misbehave on demand.

use std::sync::OnceLock;

use rps3::description::{
    Capabilities, Causality, DefaultExperiment, Definition, Initial, Unknown, Variability, Variable,
};
use rps3::fmi2::{Direction, EventUpdate, Experiment, Log, Model, ModelError, ModelResult, StepInputs, Values};
use serde::{Deserialize, Serialize};

/// Sampling period, seconds.
pub const PERIOD: f64 = 0.1;
/// The model's GUID.
pub const GUID: &str = "{00000000-0000-4000-8000-000000000001}";

/// Value references of the Reals.
pub mod real {
    pub const TIME: u32 = 0;
    pub const U: u32 = 1;
    pub const W: u32 = 2;
    pub const X: u32 = 10;
    // not in the order of the variables
    pub const V: u32 = 12;
    pub const A: u32 = 11;
    pub const Y: u32 = 13;
    pub const HELD: u32 = 14;
    pub const C: u32 = 20;
    // parameters that follow each other, without limits and with
    pub const X_START: u32 = 21;
    pub const K: u32 = 22;
    pub const GAIN: u32 = 23;
}

/// Value references of the Integers.
pub mod integer {
    pub const TICKS: u32 = 1;
    pub const SELECTOR: u32 = 2;
    pub const TROUBLE: u32 = 3;
}

/// Value references of the Booleans.
pub mod boolean {
    pub const FLAG: u32 = 1;
    pub const POSITIVE: u32 = 2;
}

/// Values of `trouble`.
pub mod trouble {
    pub const NONE: i32 = 0;
    pub const PANIC: i32 = 1;
    pub const DISCARD: i32 = 2;
    pub const ERROR: i32 = 3;
    pub const NAN: i32 = 4;
    pub const BAD_PARAMETERS: i32 = 5;
    pub const EVENT_IN_THE_PAST: i32 = 6;
    pub const WARNING: i32 = 7;
}

mod slot {
    pub const U: usize = 1;
    pub const X: usize = 3;
    pub const V: usize = 4;
    pub const A: usize = 5;
    pub const Y: usize = 6;
    pub const HELD: usize = 7;
    pub const C: usize = 8;
    pub const X_START: usize = 9;
    pub const K: usize = 10;
    pub const TICKS: usize = 0;
    pub const TROUBLE: usize = 2;
    pub const POSITIVE: usize = 1;
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Oscillator {
    states: [f64; 2],
    start: f64,
    ticks: u32,
    held: f64,
}

fn definition() -> Definition {
    let unknown = |name: &str, dependencies: &[&str]| Unknown {
        variable: name.into(),
        dependencies: dependencies.iter().map(|d| String::from(*d)).collect(),
    };
    let gain = Variable {
        causality: Causality::Local,
        variability: Variability::Constant,
        initial: Some(Initial::Exact),
        ..Variable::real("gain", real::GAIN, None, "A constant").start(2.0)
    };
    let f = &["x", "v", "u"];
    Definition {
        model_identifier: "Oscillator",
        description: "Damped oscillator with a sampled input",
        variables: vec![
            Variable::time(),
            Variable::real("u", real::U, Some("N"), "Force").input().start(0.0).range(-100.0, 100.0),
            Variable::real("w", real::W, None, "Discrete input").input().discrete().start(0.0),
            Variable::real("x", real::X, Some("m"), "Position").output(),
            Variable::real("v", real::V, Some("m/s"), "Velocity").output().derivative_of("x"),
            Variable::real("a", real::A, Some("m/s2"), "Acceleration").derivative_of("v"),
            Variable::real("y", real::Y, None, "Feed-through x + u").output(),
            Variable::real("held", real::HELD, Some("N"), "Sampled u").output().discrete(),
            Variable::real("c", real::C, None, "Damping").tunable().start(0.1).range(0.0, f64::INFINITY),
            Variable::real("x_start", real::X_START, Some("m"), "Initial position").parameter().start(1.0),
            Variable::real("k", real::K, None, "Stiffness").parameter().start(4.0).range(0.0, f64::INFINITY),
            gain,
            Variable::integer("ticks", integer::TICKS, "Samples taken").output(),
            Variable::integer("selector", integer::SELECTOR, "Discrete input").input().start_integer(0),
            Variable::integer("trouble", integer::TROUBLE, "How to misbehave")
                .tunable()
                .start_integer(0)
                .range_integer(0, 7),
            Variable::boolean("flag", boolean::FLAG, "Discrete input").input().start_boolean(false),
            Variable::boolean("positive", boolean::POSITIVE, "x > 0").output(),
        ],
        outputs: vec![
            unknown("x", &["x"]),
            unknown("v", &["v"]),
            unknown("y", &["x", "u"]),
            unknown("held", &["u"]),
            unknown("ticks", &[]),
            unknown("positive", &["x"]),
        ],
        derivatives: vec![unknown("v", &["v"]), unknown("a", f)],
        initial_unknowns: vec![
            unknown("x", &["x_start"]),
            unknown("v", &[]),
            unknown("a", &["x_start", "u", "k", "c"]),
            unknown("y", &["x_start", "u"]),
            unknown("held", &["u"]),
            unknown("ticks", &[]),
            unknown("positive", &["x_start"]),
        ],
        default_experiment: DefaultExperiment { start_time: 0.0, stop_time: 1.0, tolerance: 1e-6, step_size: 0.01 },
        capabilities: Capabilities {
            max_output_derivative_order: 1,
            can_interpolate_inputs: true,
            provides_directional_derivative: true,
        },
        event_indicators: 0,
    }
}

impl Oscillator {
    fn next_tick(&self) -> f64 {
        self.start + f64::from(self.ticks) * PERIOD
    }

    fn sample(&mut self, time: f64, u: f64) {
        if self.next_tick() <= time + 1e-9 {
            self.ticks += 1;
            self.held = u;
        }
    }

    fn write(&self, values: &mut Values) -> ModelResult {
        misbehave(values)?;
        let [x, v] = self.states;
        let r = &mut values.reals;
        r[slot::X] = x;
        r[slot::V] = v;
        r[slot::A] = acceleration(r[slot::K], r[slot::C], x, v, r[slot::U]);
        r[slot::Y] = x + r[slot::U];
        r[slot::HELD] = if values.integers[slot::TROUBLE] == trouble::NAN { f64::NAN } else { self.held };
        values.integers[slot::TICKS] = self.ticks as i32;
        values.booleans[slot::POSITIVE] = x > 0.0;
        Ok(())
    }
}

fn misbehave(values: &Values) -> ModelResult {
    match values.integers[slot::TROUBLE] {
        trouble::PANIC => panic!("100% wrong"),
        trouble::DISCARD => Err(ModelError::Discard("no convergence".into())),
        trouble::ERROR => Err(ModelError::Error("broken for good".into())),
        _ => Ok(()),
    }
}

fn acceleration(k: f64, c: f64, x: f64, v: f64, u: f64) -> f64 {
    u - k * x - c * v
}

impl Model for Oscillator {
    fn definition() -> &'static Definition {
        static DEFINITION: OnceLock<Definition> = OnceLock::new();
        DEFINITION.get_or_init(definition)
    }

    fn guid() -> &'static str {
        GUID
    }

    fn instantiate() -> Self {
        Self { states: [0.0; 2], start: 0.0, ticks: 0, held: 0.0 }
    }

    fn initialize(
        &mut self,
        values: &mut Values,
        experiment: &Experiment,
        last: bool,
        log: &mut dyn Log,
    ) -> ModelResult {
        match values.integers[slot::TROUBLE] {
            trouble::BAD_PARAMETERS => return Err(ModelError::Error("these parameters make no oscillator".into())),
            trouble::WARNING if last => log.warning("something to know, #1 of 100%"),
            _ => {}
        }
        if last {
            log.event("initialized");
        }
        *self = Self::instantiate();
        self.start = experiment.start_time;
        self.states = [values.reals[slot::X_START], 0.0];
        self.sample(experiment.start_time, values.reals[slot::U]);
        self.write(values)
    }

    fn update(&mut self, values: &mut Values, _time: f64) -> ModelResult {
        self.write(values)
    }

    fn derivatives(&self, values: &Values, _time: f64, derivatives: &mut [f64]) -> ModelResult {
        misbehave(values)?;
        let ([x, v], r) = (self.states, &values.reals);
        derivatives.copy_from_slice(&[v, acceleration(r[slot::K], r[slot::C], x, v, r[slot::U])]);
        if values.integers[slot::TROUBLE] == trouble::NAN {
            derivatives[1] = f64::NAN;
        }
        Ok(())
    }

    fn step(
        &mut self,
        values: &mut Values,
        inputs: &dyn StepInputs,
        from: f64,
        to: f64,
        _log: &mut dyn Log,
    ) -> ModelResult {
        let (k, c) = (values.reals[slot::K], values.reals[slot::C]);
        // classical Runge-Kutta: exact for cubic solutions, hence for linear inputs at k = c = 0
        let f = |t: f64, [x, v]: [f64; 2]| [v, acceleration(k, c, x, v, inputs.at(slot::U, t))];
        let along = |[x, v]: [f64; 2], [dx, dv]: [f64; 2], h: f64| [x + h * dx, v + h * dv];
        let (mut t, mut y) = (from, self.states);
        while t < to {
            self.sample(t, inputs.at(slot::U, t));
            let end = self.next_tick().min(to).min(t + 0.01);
            let end = if to - end < 1e-9 { to } else { end };
            let h = end - t;
            let k1 = f(t, y);
            let k2 = f(t + h / 2.0, along(y, k1, h / 2.0));
            let k3 = f(t + h / 2.0, along(y, k2, h / 2.0));
            let k4 = f(end, along(y, k3, h));
            for i in 0..2 {
                y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
            t = end;
        }
        self.states = y;
        self.write(values)
    }

    fn continuous_states(&self) -> &[f64] {
        &self.states
    }

    fn continuous_states_mut(&mut self) -> &mut [f64] {
        &mut self.states
    }

    fn nominals(&self, nominals: &mut [f64]) {
        nominals.copy_from_slice(&[0.5, 2.0]);
    }

    fn new_discrete_states(&mut self, values: &mut Values, time: f64, log: &mut dyn Log) -> ModelResult<EventUpdate> {
        log.event("event");
        self.sample(time, values.reals[slot::U]);
        let next = if values.integers[slot::TROUBLE] == trouble::EVENT_IN_THE_PAST { time } else { self.next_tick() };
        Ok(EventUpdate { states_changed: false, next_event_time: Some(next) })
    }

    fn directional_derivative(
        &mut self,
        values: &Values,
        direction: &Direction,
        unknowns: &[usize],
        result: &mut [f64],
    ) -> ModelResult {
        let along = |slot: usize| direction.along(slot);
        let dx = along(if direction.initialization { slot::X_START } else { slot::X });
        let dv = if direction.initialization { 0.0 } else { along(slot::V) };
        let du = along(slot::U);
        let (dk, dc) = (along(slot::K), along(slot::C));
        let [x, v] = self.states;
        for (unknown, out) in unknowns.iter().zip(result) {
            *out = match *unknown {
                slot::X => dx,
                slot::V => dv,
                slot::A => du - values.reals[slot::K] * dx - values.reals[slot::C] * dv - dk * x - dc * v,
                slot::Y => dx + du,
                _ => 0.0,
            };
        }
        Ok(())
    }

    fn output_derivative(
        &mut self,
        values: &Values,
        _time: f64,
        slot: usize,
        input_rates: &dyn Fn(usize) -> f64,
    ) -> ModelResult<f64> {
        Ok(match slot {
            slot::X => self.states[1],
            slot::V => values.reals[slot::A],
            slot::Y => self.states[1] + input_rates(slot::U),
            _ => 0.0,
        })
    }
}
