//! Numbers as a careless or hostile host might pass them.

use arbitrary::{Result, Unstructured};
use rps3::description::{Definition, Kind, Variable, VariableType};

const NASTY: [f64; 20] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::MAX,
    f64::MIN,
    f64::MIN_POSITIVE,
    5e-324,
    f64::EPSILON,
    1e-9,
    1e-3,
    1e3,
    1e9,
    1e10,
    1e150,
    -1e150,
    1e-150,
];

/// Any number, often one with which programs go wrong.
pub fn any(u: &mut Unstructured) -> Result<f64> {
    Ok(match u.int_in_range(0..=3)? {
        0 => f64::from_bits(u.arbitrary()?),
        1 => f64::from(u.arbitrary::<i16>()?) / 256.0,
        _ => *u.choose(&NASTY)?,
    })
}

/// A number near `value`, or any.
pub fn near(u: &mut Unstructured, value: f64) -> Result<f64> {
    Ok(match u.int_in_range(0..=7)? {
        0 => any(u)?,
        1 | 2 => value * f64::from(u.int_in_range(1..=1000)?) * 0.01,
        3 => value + f64::from(u.arbitrary::<i8>()?) * 0.01,
        _ => value * (1.0 + f64::from(u.arbitrary::<i8>()?) * 1e-3),
    })
}

/// A value for a Real: near its start, at a limit, or any.
pub fn real(u: &mut Unstructured, variable: &Variable) -> Result<f64> {
    let Kind::Real { start, bounds, .. } = &variable.kind else { return any(u) };
    let limits = [bounds.min, bounds.max];
    match u.int_in_range(0..=15)? {
        0 => any(u),
        k @ (1 | 2) => match limits[k - 1] {
            Some(limit) => Ok(limit),
            None => any(u),
        },
        _ => near(u, start.unwrap_or(0.1)),
    }
}

/// A value for an Integer. Of the large ones only the extremes: a swarm of 1000 over 10 000
/// iterations is legal and takes seconds a tick, at which nothing is found.
pub fn integer(u: &mut Unstructured, variable: &Variable) -> Result<i32> {
    let Kind::Integer { start, bounds } = &variable.kind else { return u.arbitrary() };
    Ok(match u.int_in_range(0..=15)? {
        0 => *u.choose(&[i32::MIN, i32::MAX, -1, 0])?,
        1 => bounds.min.unwrap_or(0),
        2 => bounds.max.unwrap_or(0).saturating_add(1),
        3..=9 => u.int_in_range(0..=5)?,
        _ => start.unwrap_or(1),
    })
}

/// The variables of a base type.
pub fn of_type(definition: &'static Definition, variable_type: VariableType) -> Vec<&'static Variable> {
    definition.variables.iter().filter(|v| v.variable_type() == variable_type).collect()
}
