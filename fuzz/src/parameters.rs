//! Random parameters: initialization refuses them, or what follows is finite.

use std::ffi::c_int;

use arbitrary::{Result, Unstructured};
use rps3::description::{Causality, VariableType};
use rps3::fmi2::api;
use rps3::fmi2::call_table::Function;
use rps3::fmi2::types::{Interface, Status};
use rps3::models::{Controller, Plant};

use super::host::{Fmu, Host, call};
use super::numbers;
use super::tally::{TALLY, count};

/// Initializes an FMU with parameters and inputs as the bytes say and makes ten steps of 1 ms, or
/// takes the derivatives in Model Exchange. Tells how that ended.
pub fn parameters(data: &[u8]) -> Status {
    let mut u = Unstructured::new(data);
    let interface = if u.ratio(1, 4).unwrap_or(false) { Interface::ModelExchange } else { Interface::CoSimulation };
    let outcome = if u.arbitrary().unwrap_or(false) {
        run::<Plant>(&mut u, interface)
    } else {
        run::<Controller>(&mut u, interface)
    };
    outcome.unwrap_or(Status::Ok)
}

fn run<M: Fmu>(u: &mut Unstructured, interface: Interface) -> Result<Status> {
    let mut host = Host::<M>::new(interface);
    let settable: Vec<_> = M::definition()
        .variables
        .iter()
        .filter(|v| matches!(v.causality, Causality::Parameter | Causality::Input))
        .collect();
    for _ in 0..u.int_in_range(1..=24)? {
        let variable = *u.choose(&settable)?;
        let reference = variable.value_reference;
        match variable.variable_type() {
            VariableType::Real => {
                let value = numbers::real(u, variable)?;
                call!(host, SetReal, set_real(&reference, 1, &value));
            }
            VariableType::Integer => {
                let value = numbers::integer(u, variable)?;
                call!(host, SetInteger, set_integer(&reference, 1, &value));
            }
            VariableType::Boolean => {
                let value = c_int::from(u.arbitrary::<bool>()?);
                call!(host, SetBoolean, set_boolean(&reference, 1, &value));
            }
        }
    }
    count(&TALLY.parameters);
    let status = host.initialize(0.0);
    if status != Status::Ok {
        return Ok(status);
    }
    if interface == Interface::ModelExchange {
        let mut derivatives = vec![f64::NAN; M::definition().derivatives.len()];
        let (target, n) = (derivatives.as_mut_ptr(), derivatives.len());
        let status = call!(host, GetDerivatives, get_derivatives(target, n));
        assert_eq!(status, Status::Ok, "the same as in initialization");
        assert!(derivatives.iter().all(|x| x.is_finite()));
        return Ok(status);
    }
    for _ in 0..10 {
        let now = host.time();
        // may be discarded: some plants move faster than any solver
        let status = host.do_step(now, 1e-3);
        if status != Status::Ok {
            return Ok(status);
        }
    }
    Ok(Status::Ok)
}
