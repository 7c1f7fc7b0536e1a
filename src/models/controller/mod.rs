//! Rps3Controller: the sampled controller behind the FMI layer.

mod dependencies;
pub mod table;

use std::collections::BTreeMap;

use nalgebra::Vector3;
use num_dual::Dual64;
use serde::{Deserialize, Serialize};

use super::{descriptions, slots};
use crate::control::mpso::{Selection, Settings};
use crate::control::{
    CHANNELS, Controller as Core, ControllerParameters, Damping, Diagnostics, ExternalReference, Gains, HoldingTerm,
    LEAST_WORK, Measurement, Mode, Profile, Reference, ReferencePoint, SensorFaults, SensorParameters, Start,
    SwarmParameters, Tuning, preview,
};
use crate::description::{Definition, VariableType};
use crate::dynamics::{MechanismParameters, PlantModel};
use crate::fmi2::{
    Direction, EventUpdate, Experiment, Lasting, Log, Model, ModelError, ModelResult, StepInputs, Values,
};
use crate::scalar::Scalar;

/// The controller and its clock.
#[derive(Debug, Serialize, Deserialize)]
pub struct Controller {
    /// `None` until the first initialization.
    core: Option<Core>,
    start_time: f64,
    sample_time: f64,
    /// Number of the next tick; it is due at start_time + tick x sample_time.
    tick: u64,
}

/// A tick this far ahead of `time` is due: masters add up step sizes, and their times drift by rounding.
fn due_ahead(time: f64, sample_time: f64) -> f64 {
    1e-6 * sample_time + 4.0 * f64::EPSILON * time.abs()
}

/// Work (see [`Core::work`]) of one call: half a minute at most, after which the host deserves an
/// answer. The default controller needs less than three quarters of it for 100 s.
const MOST_WORK: u64 = 100_000_000;

/// Slots of the variables that the glue touches.
struct Slots {
    /// First of d1..3, d1_dot..3, theta, theta_dot, i_leg, i_rev, a_x..z, ref_*.
    inputs: usize,
    /// First of the Real outputs.
    outputs: usize,
    iterations: usize,
    saturated: usize,
    in_singular_region: usize,
    sensor_fault: usize,
    revolute_motors: usize,
    reals: BTreeMap<String, usize>,
    integers: BTreeMap<&'static str, usize>,
    tuning: TuningSlots,
}

/// Slots of what may change at run time.
struct TuningSlots {
    mode: usize,
    k_p: usize,
    k_d: usize,
    k_a: usize,
    rho_fixed: usize,
    delta_hd_fixed: usize,
    lambda_f_fixed: usize,
    horizon: usize,
    weight_velocity: usize,
    weight_acceleration: usize,
}

const INTEGERS: [&str; 7] =
    ["computation_delay", "swarm_size", "max_iterations", "stall_iterations", "seed", "reference_mode", "profile"];

fn table() -> &'static (Definition, Slots) {
    static TABLE: Lasting<(Definition, Slots)> = Lasting::new();
    TABLE.get_or_init(|| {
        let definition = table::definition();
        let real = |name: &str| slots::real(&definition, name);
        let tuning = TuningSlots {
            mode: slots::integer(&definition, "control_mode"),
            k_p: real("k_p"),
            k_d: real("k_d"),
            k_a: real("k_a"),
            rho_fixed: real("rho_fixed"),
            delta_hd_fixed: real("delta_hd_fixed"),
            lambda_f_fixed: real("lambda_f_fixed"),
            horizon: real("horizon"),
            weight_velocity: real("weight_velocity"),
            weight_acceleration: real("weight_acceleration"),
        };
        let slots = Slots {
            inputs: real("d1"),
            outputs: real("v_leg1"),
            iterations: slots::integer(&definition, "mpso_iterations"),
            saturated: slots::boolean(&definition, "saturated"),
            in_singular_region: slots::boolean(&definition, "in_singular_region"),
            sensor_fault: slots::boolean(&definition, "sensor_fault"),
            revolute_motors: slots::boolean(&definition, "revolute_motors"),
            reals: slots::real_parameters(&definition),
            integers: INTEGERS.map(|name| (name, slots::integer(&definition, name))).into(),
            tuning,
        };
        (definition, slots)
    })
}

/// Parameters that hold for the whole run.
fn parameters(values: &Values) -> ControllerParameters {
    let slots = &table().1;
    let real = |name: &str| values.reals[slots.reals[name]];
    let integer = |name: &str| values.integers[slots.integers[name]];
    // the table's range keeps counts positive
    let count = |name: &str| usize::try_from(integer(name)).unwrap_or(0);
    let waypoint = |point: &str| COORDINATES.map(|name| real(&format!("{point}_{name}")));
    ControllerParameters {
        mechanism: MechanismParameters::by_name(real, values.booleans[slots.revolute_motors]),
        sample_time: real("sample_time"),
        computation_delay: integer("computation_delay") == 1,
        waypoints: POINTS.map(waypoint),
        move_time: real("move_time"),
        profile: if integer("profile") == 1 { Profile::ConstantSpeed } else { Profile::Quintic },
        external_reference: integer("reference_mode") == 2,
        sensors: SensorParameters {
            scale: real("sensor_scale"),
            length_resolution: real("sensor_length_resolution"),
            angle_resolution: real("sensor_angle_resolution"),
            length_noise: real("sensor_length_noise"),
            angle_noise: real("sensor_angle_noise"),
            length_bias: real("sensor_length_bias"),
        },
        sensor_timeout: real("sensor_timeout"),
        filter_time: real("filter_time"),
        swarm: SwarmParameters {
            settings: Settings {
                swarm_size: count("swarm_size"),
                max_iterations: count("max_iterations"),
                stall_iterations: count("stall_iterations"),
                c1: real("c1"),
                c2: real("c2"),
                inertia_max: real("inertia_max"),
                inertia_min: real("inertia_min"),
                decay_max: real("decay_max"),
                decay_min: real("decay_min"),
                regulating_scale: real("regulating_scale"),
                velocity_limit: real("velocity_limit"),
                selection: Selection::Ranked,
            },
            largest: Damping { rho: real("rho_max"), delta_hd: real("delta_hd_max"), lambda_f: real("lambda_f_max") },
        },
        seed: u64::try_from(integer("seed")).unwrap_or(0),
    }
}

/// What may change between ticks, by a function from the slot.
fn tuning_from<T: Scalar>(values: &Values, real: impl Fn(usize) -> T) -> Tuning<T> {
    let slots = &table().1.tuning;
    Tuning {
        mode: match values.integers[slots.mode] {
            1 => Mode::Rac,
            2 => Mode::Drac,
            3 => Mode::Hdrac,
            _ => Mode::HdracMpso,
        },
        gains: Gains { position: real(slots.k_p), velocity: real(slots.k_d), acceleration: real(slots.k_a) },
        fixed: Damping {
            rho: real(slots.rho_fixed),
            delta_hd: real(slots.delta_hd_fixed),
            lambda_f: real(slots.lambda_f_fixed),
        },
        horizon: real(slots.horizon),
        weight_velocity: real(slots.weight_velocity),
        weight_acceleration: real(slots.weight_acceleration),
        holding: HoldingTerm::default(),
    }
}

fn tuning(values: &Values) -> Tuning {
    tuning_from(values, |slot| values.reals[slot])
}

/// Measurements and external reference by a function from the slot.
fn inputs_from<T: Scalar>(at: impl Fn(usize) -> T) -> (Measurement<T>, ReferencePoint<T>) {
    let first = table().1.inputs;
    let vector = |k: usize| Vector3::new(at(first + 3 * k), at(first + 3 * k + 1), at(first + 3 * k + 2));
    let measurement = Measurement {
        lengths: vector(0),
        length_rates: vector(1),
        angles: vector(2),
        angle_rates: vector(3),
        leg_currents: vector(4),
        revolute_currents: vector(5),
        acceleration: vector(6),
    };
    (measurement, ReferencePoint { position: vector(7), rate: vector(8), acceleration: vector(9) })
}

/// `measured` with NaN for what the host could not provide.
fn with_gaps(values: &Values, measured: &Measurement<f64>) -> Measurement<f64> {
    let first = table().1.inputs;
    let mut channels = measured.to_array();
    for (channel, missing) in channels.iter_mut().zip(&values.missing[first..]) {
        if *missing {
            *channel = f64::NAN;
        }
    }
    Measurement::from_array(&channels)
}

/// Tells of faults that have come or gone.
fn report(before: SensorFaults, now: SensorFaults, log: &mut dyn Log) {
    let (definition, slots) = table();
    let names = |channels: u32| -> String {
        let reals = definition.variables.iter().filter(|v| v.variable_type() == VariableType::Real).skip(slots.inputs);
        let names = reals.take(CHANNELS).enumerate().filter(|(channel, _)| channels & (1 << channel) != 0);
        names.map(|(_, variable)| variable.name.as_str()).collect::<Vec<_>>().join(", ")
    };
    let missing = now.missing & !before.missing;
    if missing != 0 {
        log.warning(&format!("sensor fault: {} missing, the last valid measurement is used", names(missing)));
    }
    let frozen = now.frozen & !before.frozen;
    if frozen != 0 {
        log.warning(&format!("sensor fault: {} frozen, although its rate says that it moves", names(frozen)));
    }
    if now.cut_off && !before.cut_off {
        log.warning("sensor fault: it has lasted for sensor_timeout, the voltages are zero");
    }
    if before.any() && !now.any() {
        log.event("sensor fault: all measurements are valid again");
    }
}

/// The Real outputs in the table's order, in consecutive slots.
fn real_outputs<T: Scalar>(d: &Diagnostics<T>) -> [T; 22] {
    let v = &d.voltages;
    let (e, r) = (&d.estimate, &d.reference);
    [
        v[0],
        v[1],
        v[2],
        v[3],
        v[4],
        v[5],
        d.damping.rho,
        d.rho_hd,
        d.damping.delta_hd,
        d.damping.lambda_f,
        d.sigma_min,
        d.lyapunov,
        d.lyapunov_rate,
        e.x,
        e.y,
        e.z,
        r.x,
        r.y,
        r.z,
        d.position_error,
        d.rotation_error,
        d.fitness,
    ]
}

fn write(values: &mut Values, d: &Diagnostics, sensor_fault: bool) {
    let slots = &table().1;
    let outputs = real_outputs(d);
    values.reals[slots.outputs..slots.outputs + outputs.len()].copy_from_slice(&outputs);
    values.integers[slots.iterations] = i32::try_from(d.iterations).unwrap_or(i32::MAX);
    values.booleans[slots.saturated] = d.saturated;
    values.booleans[slots.in_singular_region] = d.sigma_min < values.reals[slots.tuning.delta_hd_fixed];
    values.booleans[slots.sensor_fault] = sensor_fault;
}

impl Controller {
    /// When the next tick is due, s: computed from an integer, so that it does not drift.
    fn due(&self) -> f64 {
        self.start_time + self.tick as f64 * self.sample_time
    }

    /// Whether a tick belongs to a step that ends at `to`, s. One at `to` itself belongs to the next: the master has
    /// yet to set the inputs for it.
    fn is_due_before(&self, to: f64) -> bool {
        self.due() < to - due_ahead(to, self.sample_time)
    }

    /// Makes the due tick with these inputs, `fresh` if the host may have set them since the last.
    fn make_tick(
        &mut self,
        values: &mut Values,
        (measured, external): (Measurement<f64>, ReferencePoint<f64>),
        fresh: bool,
        log: &mut dyn Log,
    ) -> ModelResult {
        let core = self.core.as_mut().ok_or_else(not_initialized)?;
        let t = self.tick as f64 * self.sample_time;
        let (before, contradicted) = (core.sensor_faults(), core.contradiction().is_some());
        let measured = with_gaps(values, &measured);
        let diagnostics = core
            .watched_tick(t, &measured, fresh, &external, &tuning(values))
            .map_err(|error| ModelError::Discard(error.to_string()))?;
        let faults = core.sensor_faults();
        if faults != before {
            report(before, faults, log);
        }
        if let (false, Some(length)) = (contradicted, core.contradiction()) {
            log.warning(&format!(
                "the measurements contradict each other: the pose that fits them best leaves an error of {:.0} mm",
                1e3 * length
            ));
        }
        write(values, &diagnostics, faults.any());
        self.tick += 1;
        Ok(())
    }

    /// Makes the ticks up to `end` (s) for which `is_due`, with the inputs at their time.
    fn make_ticks(
        &mut self,
        values: &mut Values,
        end: f64,
        is_due: impl Fn(&Self) -> bool,
        inputs: impl Fn(&Values, f64) -> (Measurement<f64>, ReferencePoint<f64>),
        log: &mut dyn Log,
    ) -> ModelResult {
        let first = self.tick;
        let too_much = |ticks: f64| Err(ModelError::Discard(format!("{ticks} ticks are too much work for one call")));
        // a host that jumps ahead should not wait to be told so
        let ticks = libm::round((end - self.due()) / self.sample_time);
        if ticks * LEAST_WORK as f64 > MOST_WORK as f64 {
            return too_much(ticks);
        }
        let work = |controller: &Self| controller.core.as_ref().map_or(0, Core::work);
        let before = work(self);
        while is_due(self) {
            if work(self) - before > MOST_WORK {
                return too_much(ticks);
            }
            let inputs = inputs(values, self.due());
            self.make_tick(values, inputs, self.tick == first, log)?;
        }
        Ok(())
    }

    /// The outputs during initialization, those of the first tick, in dual numbers.
    fn preview(&self, values: &Values, dual: impl Fn(usize) -> Dual64) -> ModelResult<Diagnostics<Dual64>> {
        let slots = &table().1;
        let core = self.core.as_ref().ok_or_else(not_initialized)?;
        let parameter = |name: &str| dual(slots.reals[name]);
        let ControllerParameters { profile, external_reference, mechanism, .. } = *core.parameters();
        let model = PlantModel::without_stops(&MechanismParameters::by_name(parameter, mechanism.revolute_motors));
        let (truth, external) = inputs_from(&dual);
        let (measured, estimate) = core.first_estimate(&model.geometry, &truth, |x| x.re);
        let tuning = tuning_from(values, &dual);
        let (reference, ahead) = if external_reference {
            (external, ExternalReference(external).ahead(tuning.horizon))
        } else {
            let waypoints =
                POINTS.map(|point| Vector3::from(COORDINATES.map(|name| parameter(&format!("{point}_{name}")))));
            let internal = Reference::new(waypoints, parameter("move_time"), profile, model.geometry.joint_radius);
            (internal.at(Dual64::from(0.0)), internal.at(tuning.horizon))
        };
        let start = Start { measured, estimate, reference, ahead, sample_time: parameter("sample_time") };
        let found = |k: usize| Dual64::from(values.reals[slots.outputs + k]);
        let found = Damping { rho: found(RHO), delta_hd: found(RHO + 2), lambda_f: found(RHO + 3) };
        preview(&model, &start, &tuning, &found)
            .ok_or_else(|| ModelError::Discard("J is singular: undamped outputs have no derivative here".into()))
    }
}

/// Place of rho among the Real outputs; rho_hd, delta_hd and lambda_f follow.
const RHO: usize = 6;
const POINTS: [&str; 3] = ["start", "via", "end"];
const COORDINATES: [&str; 3] = ["heave", "tilt_x", "tilt_y"];

fn not_initialized() -> ModelError {
    ModelError::Error("not initialized".into())
}

/// Written out, since the derived `clone_from` would allocate at every step's backup.
impl Clone for Controller {
    fn clone(&self) -> Self {
        Self { core: self.core.clone(), ..*self }
    }

    fn clone_from(&mut self, source: &Self) {
        self.core.clone_from(&source.core);
        (self.start_time, self.sample_time, self.tick) = (source.start_time, source.sample_time, source.tick);
    }
}

impl Model for Controller {
    fn definition() -> &'static Definition {
        &table().0
    }

    fn guid() -> &'static str {
        descriptions::CONTROLLER.guid
    }

    fn instantiate() -> Self {
        Self { core: None, start_time: 0.0, sample_time: crate::defaults::SAMPLE_TIME, tick: 0 }
    }

    fn initialize(
        &mut self,
        values: &mut Values,
        experiment: &Experiment,
        _last: bool,
        _log: &mut dyn Log,
    ) -> ModelResult {
        let parameters = parameters(values);
        let refuse = |error: crate::control::ControlError| ModelError::Error(error.to_string());
        let mut core = Core::new(parameters).map_err(refuse)?;
        // Outputs during initialization are those of the first tick, made on a copy: the tick itself
        // belongs to the first step or event, and must not find used random numbers.
        let (measured, external) = inputs_from(|slot| values.reals[slot]);
        let mut preview = core.clone();
        let diagnostics = preview.tick(0.0, &measured, &external, &tuning(values), false).map_err(refuse)?;
        core.assume(&diagnostics.voltages, &measured);
        let gaps = with_gaps(values, &measured).to_array().iter().any(|reading| reading.is_nan());
        write(values, &diagnostics, gaps);
        self.core = Some(core);
        self.start_time = experiment.start_time;
        self.sample_time = parameters.sample_time;
        self.tick = 0;
        Ok(())
    }

    fn update(&mut self, _values: &mut Values, _time: f64) -> ModelResult {
        // outputs change at ticks only
        Ok(())
    }

    fn derivatives(&self, _values: &Values, _time: f64, _derivatives: &mut [f64]) -> ModelResult {
        // there are no states
        Ok(())
    }

    fn idle_until(&self, to: f64) -> bool {
        !self.is_due_before(to)
    }

    fn step(
        &mut self,
        values: &mut Values,
        inputs: &dyn StepInputs,
        from: f64,
        to: f64,
        log: &mut dyn Log,
    ) -> ModelResult {
        self.make_ticks(
            values,
            to,
            |controller| controller.is_due_before(to),
            |_, due| inputs_from(|slot| inputs.at(slot, due.max(from))),
            log,
        )
    }

    fn continuous_states(&self) -> &[f64] {
        &[]
    }

    fn continuous_states_mut(&mut self) -> &mut [f64] {
        &mut []
    }

    fn nominals(&self, _nominals: &mut [f64]) {}

    fn new_discrete_states(&mut self, values: &mut Values, time: f64, log: &mut dyn Log) -> ModelResult<EventUpdate> {
        self.make_ticks(
            values,
            time,
            |controller| controller.due() <= time + due_ahead(time, controller.sample_time),
            |values, _| inputs_from(|slot| values.reals[slot]),
            log,
        )?;
        Ok(EventUpdate { states_changed: false, next_event_time: Some(self.due()) })
    }

    fn directional_derivative(
        &mut self,
        values: &Values,
        direction: &Direction,
        unknowns: &[usize],
        result: &mut [f64],
    ) -> ModelResult {
        if !direction.initialization {
            // between ticks the outputs are held
            result.fill(0.0);
            return Ok(());
        }
        let dual = |slot: usize| Dual64::new(values.reals[slot], direction.along(slot));
        let outputs = real_outputs(&self.preview(values, dual)?);
        let first = table().1.outputs;
        for (slot, value) in unknowns.iter().zip(result) {
            let output = slot.checked_sub(first).and_then(|place| outputs.get(place));
            *value = output.ok_or_else(|| ModelError::Error("not a Real output".into()))?.eps;
        }
        Ok(())
    }

    fn output_derivative(
        &mut self,
        _values: &Values,
        _time: f64,
        _slot: usize,
        _input_rates: &dyn Fn(usize) -> f64,
    ) -> ModelResult<f64> {
        Ok(0.0)
    }
}
