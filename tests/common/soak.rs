//! The coupled pair for a long time, as a host would drive it over the C functions: what it costs in
//! time and memory, and how well it works, window by window.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use rps3::control::{Profile, Reference, ReferencePoint};
use rps3::description::VariableType;
use rps3::dynamics::PlantParameters;
use rps3::fmi2::types::{Status, ValueReference};
use rps3::models::{Controller, Plant};
use rps3::study::Crossing;

use super::{COUPLED_STEP, Slave, Wires, measure};

/// A crossing and a rest at its end, s.
const MOVE: f64 = 1.0;
const LAP: f64 = 1.4;
const LAP_STEPS: u32 = 1400;

/// A part of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Crossings of the singular surface.
    pub crossings: u32,
    /// Steps of the pair in which a call did not return `fmi2OK`.
    pub failed_steps: u32,
    /// Steps after which the controller reported a sensor fault.
    pub faults: u32,
    /// CPU time of this thread by simulated second.
    pub cost: f64,
    /// Memory of the process, kB; Linux only.
    pub resident: Option<u64>,
    /// Largest component of (heave, r_b tilt) errors, m, and the largest at the end of a rest.
    pub peak_error: f64,
    pub end_error: f64,
}

/// A pair with the time that it has counted.
struct Pair {
    plant: Slave<Plant>,
    controller: Slave<Controller>,
    wires: Wires,
    /// Steps since the last initialization.
    steps: u32,
    pose: [ValueReference; 3],
    reference: [ValueReference; 9],
    joint_radius: f64,
}

impl Pair {
    fn new() -> Self {
        let names = ["heave", "tilt_x", "tilt_y"];
        let controller_reference = |name: String| Slave::<Controller>::reference(&name, VariableType::Real);
        let suffixed = |suffix: &str| names.map(|name| controller_reference(format!("ref_{name}{suffix}")));
        let [p, v, a] = ["", "_dot", "_ddot"].map(suffixed);
        Self {
            plant: Slave::new(),
            controller: Slave::new(),
            wires: Wires::new(),
            steps: 0,
            pose: names.map(|name| Slave::<Plant>::reference(name, VariableType::Real)),
            reference: [p[0], p[1], p[2], v[0], v[1], v[2], a[0], a[1], a[2]],
            joint_radius: PlantParameters::default().mechanism.joint_spacing / 3.0_f64.sqrt(),
        }
    }

    /// Back to before initialization, then to the start of `waypoints` with the reference from outside.
    fn begin(&mut self, mode: i32, waypoints: &[[f64; 3]; 3]) {
        self.plant.reset();
        self.controller.reset();
        self.controller.set_integer("control_mode", mode);
        self.controller.set_integer("reference_mode", 2);
        for (k, name) in ["heave", "tilt_x", "tilt_y"].iter().enumerate() {
            assert_eq!(self.plant.set_real(&format!("{name}_start"), waypoints[0][k]), Status::Ok);
        }
        self.plant.initialize();
        measure(&self.plant, &self.controller);
        self.refer(&self.path(waypoints).at(0.0));
        self.controller.initialize();
        self.steps = 0;
    }

    fn path(&self, waypoints: &[[f64; 3]; 3]) -> Reference<f64> {
        Reference::new(waypoints.map(Vector3::from), MOVE, Profile::Quintic, self.joint_radius)
    }

    fn refer(&self, point: &ReferencePoint<f64>) {
        let values: Vec<f64> =
            [point.position, point.rate, point.acceleration].iter().flat_map(|v| v.iter().copied()).collect();
        assert_eq!(self.controller.set_references(&self.reference, &values), Status::Ok);
    }

    /// From the first waypoint to the last, and a rest there.
    fn lap(&mut self, waypoints: &[[f64; 3]; 3], window: &mut Window) {
        let path = self.path(waypoints);
        let mut error = 0.0;
        for k in 0..LAP_STEPS {
            self.refer(&path.at(f64::from(k) * COUPLED_STEP));
            let point = f64::from(self.steps) * COUPLED_STEP;
            if !self.wires.step(&self.plant, &self.controller, point, COUPLED_STEP) {
                window.failed_steps += 1;
                println!("at {point} s: {:?} {:?}", self.controller.take_messages(), self.plant.take_messages());
                return;
            }
            self.steps += 1;
            window.faults += u32::from(self.controller.boolean("sensor_fault"));
            let pose = Vector3::from_vec(self.plant.get_references(&self.pose));
            let off = pose - path.at(f64::from(k + 1) * COUPLED_STEP).position;
            error = off.x.abs().max(self.joint_radius * off.y.abs()).max(self.joint_radius * off.z.abs());
            window.peak_error = window.peak_error.max(error);
        }
        window.crossings += 1;
        window.end_error = window.end_error.max(error);
    }
}

/// One window of `laps`, measured.
fn window(laps: u32, mut lap: impl FnMut(&mut Window)) -> Window {
    let mut window =
        Window { crossings: 0, failed_steps: 0, faults: 0, cost: 0.0, resident: None, peak_error: 0.0, end_error: 0.0 };
    let begin = cpu_time();
    for _ in 0..laps {
        lap(&mut window);
    }
    window.cost = (cpu_time() - begin) / (f64::from(laps) * LAP);
    window.resident = resident();
    window
}

/// To and fro through the default singular pose without a pause, in `windows` of so many crossings.
pub fn to_and_fro(mode: i32, windows: u32, crossings: u32, mut observe: impl FnMut(&Window)) {
    let there = Crossing::default().waypoints;
    let [start, via, end] = there;
    let back = [end, via, start];
    let mut pair = Pair::new();
    pair.begin(mode, &there);
    let mut forth = true;
    for _ in 0..windows {
        observe(&window(crossings, |window| {
            pair.lap(if forth { &there } else { &back }, window);
            forth = !forth;
        }));
    }
}

/// Random crossings, the same two instances reset for each, in `windows` of so many.
pub fn random_crossings(mode: i32, windows: u32, crossings: u32, mut observe: impl FnMut(&Window)) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let plant = PlantParameters::default();
    let mut pair = Pair::new();
    for _ in 0..windows {
        observe(&window(crossings, |window| {
            let waypoints = Crossing::random(&plant, &mut rng).waypoints;
            pair.begin(mode, &waypoints);
            pair.lap(&waypoints, window);
        }));
    }
}

/// CPU time of this thread, s: other programs do not count.
fn cpu_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: a valid clock and a place for the answer.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// kB
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.split_whitespace().next()?.parse().ok()
}
