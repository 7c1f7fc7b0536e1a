//! The dynamics on standard input and output, so that other rigid-body codes can be held against
//! them: one JSON request a line, one JSON answer a line.
//!
//! A request holds `parameters` (all fields of [`MechanismParameters`], SI units), `states` (rows
//! of the 12 states), `loads` (rows of external force, N, and moment, N.m, on the platform). The
//! answer has a row for each state of every quantity in [`Answer`]. A request with `times` (s)
//! holds the currents of its one state constant and answers with the coordinates at those times.

use std::io::{BufRead, Write};

use nalgebra::{SVector, Vector3};
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{Inputs, MechanismParameters, PlantModel, PlantState, evaluate, reactions};

#[derive(serde::Deserialize)]
struct Request {
    parameters: MechanismParameters,
    states: Vec<[f64; 12]>,
    loads: Vec<[f64; 6]>,
    #[serde(default)]
    times: Vec<f64>,
}

#[derive(serde::Serialize, Default)]
struct Answer {
    /// Accelerations of P, m/s2, and about it, rad/s2, base frame.
    linear: Vec<[f64; 3]>,
    angular: Vec<[f64; 3]>,
    /// Of the limb lengths, m/s2, and angles, rad/s2.
    length: Vec<[f64; 3]>,
    angle: Vec<[f64; 3]>,
    /// Forces of the limbs on the platform in the limbs' frames, N.
    axial: Vec<[f64; 3]>,
    normal: Vec<[f64; 3]>,
    lateral: Vec<[f64; 3]>,
    /// (heave in m, tilt_x, tilt_y in rad) at the requested times.
    coordinates: Vec<[f64; 3]>,
}

fn answer(request: &Request) -> anyhow::Result<Answer> {
    let model = PlantModel::<f64>::without_stops(&request.parameters);
    let mut answer = Answer::default();
    for (state, load) in request.states.iter().zip(&request.loads) {
        let inputs = Inputs {
            force: Vector3::new(load[0], load[1], load[2]),
            moment: Vector3::new(load[3], load[4], load[5]),
            ..Inputs::zero()
        };
        let x = PlantState::from(*state);
        let e = evaluate(&model, &x, &inputs);
        let joint_forces = reactions(&model, &e, &inputs);
        answer.linear.push((e.motion.linear_bias + e.pose.linear_map * e.acceleration).into());
        answer.angular.push((e.motion.angular_bias + e.pose.angular_map * e.acceleration).into());
        let limbs = [0, 1, 2];
        answer
            .length
            .push(limbs.map(|i| e.limb_motions[i].length_bias + e.limbs[i].length_gradient.dot(&e.acceleration)));
        answer.angle.push(limbs.map(|i| e.limb_motions[i].angle_bias + e.limbs[i].angle_gradient.dot(&e.acceleration)));
        answer.axial.push(joint_forces.axial.into());
        answer.normal.push(joint_forces.normal.into());
        answer.lateral.push(joint_forces.lateral.into());
        if !request.times.is_empty() {
            answer.coordinates = trajectory(&model, &x, &inputs, &request.times)?;
        }
    }
    Ok(answer)
}

/// Coordinates at `times` with the currents of `start` held.
fn trajectory(
    model: &PlantModel<f64>,
    start: &PlantState<f64>,
    inputs: &Inputs<f64>,
    times: &[f64],
) -> anyhow::Result<Vec<[f64; 3]>> {
    let currents = start.fixed_rows::<6>(6).into_owned();
    let right_hand_side = |_: f64, motion: &SVector<f64, 6>| {
        let mut x = PlantState::zeros();
        x.fixed_rows_mut::<6>(0).copy_from(motion);
        x.fixed_rows_mut::<6>(6).copy_from(&currents);
        evaluate(model, &x, inputs).derivative.fixed_rows::<6>(0).into_owned()
    };
    let settings = Settings { tolerance: 1e-12, nominal: [0.1, 0.1, 0.1, 1.0, 1.0, 1.0], max_step: 0.01 };
    let mut solver = Solver::default();
    let mut motion = start.fixed_rows::<6>(0).into_owned();
    let mut time = 0.0;
    let mut coordinates = Vec::with_capacity(times.len());
    for &next in times {
        if next > time {
            solver.integrate(right_hand_side, &mut motion, time, next, &settings)?;
            time = next;
        }
        coordinates.push([motion[0], motion[1], motion[2]]);
    }
    Ok(coordinates)
}

fn main() -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    for line in std::io::stdin().lock().lines() {
        serde_json::to_writer(&mut out, &answer(&serde_json::from_str(&line?)?)?)?;
        writeln!(out)?;
    }
    Ok(())
}
