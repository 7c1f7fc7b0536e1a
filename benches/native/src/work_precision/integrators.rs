//! The integrators by one signature: states at the ends of the segments, each started at the end of the
//! one before. Absolute tolerances are the nominal magnitudes times the tolerance where a library takes
//! one a component, else times the smallest.

use anyhow::{Result, anyhow};
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::prelude::{IVP, ODE};
use diffsol::{MatrixCommon, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use ode_solvers::OutputType;
use rps3::dynamics::solver::{Settings, Solver};
use rps3::dynamics::{NOMINAL, PlantState};

use super::{Segment, State};

pub type Solve = fn(&[Segment], State, f64) -> Result<Vec<State>>;

/// Solves a segment by a pair of the crate differential-equations.
macro_rules! explicit {
    ($method:ident) => {
        |segments, start, tolerance| {
            chain(segments, start, |segment, x| {
                let method = ExplicitRungeKutta::$method().rtol(tolerance);
                let solution = IVP::ode(&segment, 0.0, segment.duration, x)
                    .method(method.atol(NOMINAL.map(|nominal| nominal * tolerance)))
                    .solve()
                    .map_err(|error| anyhow!("{error:?}"))?;
                Ok(*solution.last().map_err(|error| anyhow!("{error:?}"))?.1)
            })
        }
    };
}

/// Solves a segment by a method of the crate diffsol, with the exact Jacobian.
macro_rules! diffsol {
    ($method:ident $(::<$linear:ty>)?) => {
        |segments, start, tolerance| {
            chain(segments, start, |segment, x| {
                let problem = OdeBuilder::<NalgebraMat<f64>>::new()
                    .rtol(tolerance)
                    .atol(NOMINAL.map(|nominal| nominal * tolerance))
                    .rhs_implicit(
                        |x, _, _, x_dot| x_dot.copy_from_slice(&segment.derivative(&array(x))),
                        |x, _, _, v, product| product.copy_from_slice(&segment.along(&array(x), &array(v))),
                    )
                    .init(|_, _, start| start.copy_from_slice(&x), 12)
                    .build()?;
                let mut solver = problem.$method$(::<$linear>)?()?;
                let (states, ..) = solver.solve(segment.duration)?;
                let states = states.inner();
                Ok(std::array::from_fn(|i| states[(i, states.ncols() - 1)]))
            })
        }
    };
}

/// Everything that is compared.
pub const ALL: [(&str, Solve); 10] = [
    ("DOP853, rps3", rps3),
    ("DOP853, ode_solvers", ode_solvers_dop853),
    ("DOPRI5, ode_solvers", ode_solvers_dopri5),
    ("DOP853, differential-equations", explicit!(dop853)),
    ("DOPRI5, differential-equations", explicit!(dopri5)),
    ("Verner 6(5), differential-equations", explicit!(rkv655e)),
    ("Verner 7(6), differential-equations", explicit!(rkv766e)),
    ("TSIT45, diffsol", diffsol!(tsit45)),
    ("ESDIRK34, diffsol", diffsol!(esdirk34::<Lu>)),
    ("BDF, diffsol", diffsol!(bdf::<Lu>)),
];

fn rps3(segments: &[Segment], start: State, tolerance: f64) -> Result<Vec<State>> {
    let settings = Settings { tolerance, nominal: NOMINAL, max_step: f64::INFINITY };
    let (mut x, mut solver) = (PlantState::from(start), Solver::default());
    let mut ends = Vec::with_capacity(segments.len());
    for segment in segments {
        let f = |_: f64, x: &PlantState<f64>| segment.derivative(&(*x).into()).into();
        solver.integrate(f, &mut x, 0.0, segment.duration, &settings)?;
        ends.push(x.into());
    }
    Ok(ends)
}

/// Runs `step` over all segments.
fn chain(segments: &[Segment], start: State, step: impl Fn(&Segment, State) -> Result<State>) -> Result<Vec<State>> {
    let mut x = start;
    let mut ends = Vec::with_capacity(segments.len());
    for segment in segments {
        x = step(segment, x)?;
        ends.push(x);
    }
    Ok(ends)
}

type Vector = ode_solvers::SVector<f64, 12>;

impl ode_solvers::System<f64, Vector> for &Segment<'_> {
    fn system(&self, _: f64, x: &Vector, x_dot: &mut Vector) {
        *x_dot = self.derivative(&(*x).into()).into();
    }
}

/// The smallest nominal magnitude: these solvers take one absolute tolerance for all.
const SMALLEST: f64 = 0.1;

fn ode_solvers_dop853(segments: &[Segment], start: State, tolerance: f64) -> Result<Vec<State>> {
    chain(segments, start, |segment, x| {
        let span = segment.duration;
        let x = Vector::from(x);
        let mut solver = ode_solvers::Dop853::new(segment, 0.0, span, span, x, tolerance, tolerance * SMALLEST);
        // not by interpolation, which is less accurate
        solver.set_output(OutputType::Sparse);
        solver.integrate().map_err(|error| anyhow!("{error}"))?;
        last(solver.y_out())
    })
}

fn ode_solvers_dopri5(segments: &[Segment], start: State, tolerance: f64) -> Result<Vec<State>> {
    chain(segments, start, |segment, x| {
        let span = segment.duration;
        let x = Vector::from(x);
        let mut solver = ode_solvers::Dopri5::new(segment, 0.0, span, span, x, tolerance, tolerance * SMALLEST);
        // not by interpolation, which is less accurate
        solver.set_output(OutputType::Sparse);
        solver.integrate().map_err(|error| anyhow!("{error}"))?;
        last(solver.y_out())
    })
}

fn last(outputs: &[Vector]) -> Result<State> {
    outputs.last().map(|x| (*x).into()).ok_or_else(|| anyhow!("no output"))
}

impl ODE<f64, State> for &Segment<'_> {
    fn diff(&self, _: f64, x: &State, x_dot: &mut State) {
        *x_dot = self.derivative(x);
    }
}

type Lu = NalgebraLU<f64>;

fn array(x: &[f64]) -> State {
    std::array::from_fn(|i| x[i])
}
