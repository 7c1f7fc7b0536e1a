//! Spoiled and forged states.

use std::ptr;

use arbitrary::{Result, Unstructured};
use rps3::fmi2::api;
use rps3::fmi2::call_table::{Function, Mode};
use rps3::fmi2::types::{EventInfo, FmuState, Interface, Status};
use rps3::models::{Controller, Plant};

use super::host::{Fmu, Host, call};

/// Gives an FMU states that were changed as the bytes say. A spoiled one is refused; one whose
/// checksum was forged to fit may be taken, and then nothing worse happens than an error. Ends with
/// the first that is taken, or with the bytes.
pub fn states(data: &[u8]) -> Status {
    let mut u = Unstructured::new(data);
    let interface = if u.arbitrary().unwrap_or(false) { Interface::ModelExchange } else { Interface::CoSimulation };
    let outcome = if u.arbitrary().unwrap_or(false) {
        run::<Plant>(&mut u, interface)
    } else {
        run::<Controller>(&mut u, interface)
    };
    outcome.unwrap_or(Status::Ok)
}

fn run<M: Fmu>(u: &mut Unstructured, interface: Interface) -> Result<Status> {
    let mut host = Host::<M>::new(interface);
    host.quick_ticks(u);
    if u.arbitrary()? {
        assert_eq!(host.initialize(0.0), Status::Ok);
        if interface == Interface::CoSimulation && u.arbitrary()? {
            assert_eq!(host.do_step(0.0, 1e-3), Status::Ok);
        }
    }
    let original = host.fingerprint();
    loop {
        let mut bytes = original.clone();
        for _ in 0..u.int_in_range(1..=8)? {
            change(u, &mut bytes)?;
        }
        let forged = u.ratio(1, 4)?;
        if forged {
            forge(&mut bytes);
        }
        let mut handle = ptr::null_mut();
        let (pointer, n) = (bytes.as_ptr(), bytes.len());
        let status = call!(host, DeSerializeFmuState, deserialize_fmu_state(pointer, n, &mut handle));
        if status == Status::Ok {
            assert!(forged || bytes == original, "a spoiled state was taken");
            return live_on(host, handle);
        }
        assert!(handle.is_null());
        assert!(host.fingerprint() == original, "a refused state left traces");
        if u.is_empty() {
            return Ok(status);
        }
    }
}

/// What an instance goes through with a state that it took.
fn live_on<M: Fmu>(mut host: Host<M>, mut handle: FmuState) -> Result<Status> {
    assert_eq!(call!(host, SetFmuState, set_fmu_state(handle)), Status::Ok);
    let taken = host.fingerprint();
    host.mode = mode(&taken);
    exercise(&mut host);
    assert_eq!(call!(host, FreeFmuState, free_fmu_state(&mut handle)), Status::Ok);
    assert_eq!(call!(host, Reset, reset()), Status::Ok);
    host.mode = Mode::Instantiated;
    assert_eq!(host.initialize(0.0), Status::Ok, "reset leads out of any state");
    Ok(Status::Ok)
}

/// A call of each sort that the state allows; how they end is up to the state.
fn exercise<M: Fmu>(host: &mut Host<M>) {
    host.read_everything();
    if host.mode == Mode::Initialization {
        host.exit_initialization_mode();
    }
    match host.mode {
        Mode::StepComplete => {
            let time = host.time();
            // short: a forged solver may take its million steps over it
            host.do_step(time, 1e-6);
        }
        Mode::Event => {
            let mut info = EventInfo::default();
            if call!(host, NewDiscreteStates, new_discrete_states(&mut info)) == Status::Ok {
                let mut derivatives = vec![f64::NAN; M::definition().derivatives.len()];
                let (target, n) = (derivatives.as_mut_ptr(), derivatives.len());
                if call!(host, GetDerivatives, get_derivatives(target, n)) == Status::Ok {
                    assert!(derivatives.iter().all(|x| x.is_finite()));
                }
            }
        }
        _ => {}
    }
    host.read_everything();
}

fn change(u: &mut Unstructured, bytes: &mut Vec<u8>) -> Result<()> {
    if bytes.is_empty() {
        return Ok(());
    }
    let place = u.choose_index(bytes.len())?;
    match u.int_in_range(0..=6)? {
        0 => bytes.truncate(place),
        1 => bytes.insert(place, u.arbitrary()?),
        2 => {
            bytes.remove(place);
        }
        3 => {
            // one number for another
            let number: f64 = super::numbers::any(u)?;
            let end = bytes.len().min(place + 8);
            let n = end - place;
            bytes[place..end].copy_from_slice(&number.to_le_bytes()[..n]);
        }
        4 => {
            let end = bytes.len().min(place + u.int_in_range(1..=16)?);
            bytes[place..end].fill(u.arbitrary()?);
        }
        _ => bytes[place] ^= u.int_in_range(1..=255)?,
    }
    Ok(())
}

/// Corrects length and checksum, so that the content is looked at.
fn forge(bytes: &mut [u8]) {
    let Some(header) = bytes.get(12..16) else { return };
    let guid = u32::from_le_bytes([header[0], header[1], header[2], header[3]]) as usize;
    let Some(payload) = guid.checked_add(24) else { return };
    if bytes.len() < payload.saturating_add(4) {
        return;
    }
    let end = bytes.len() - 4;
    bytes[payload - 8..payload].copy_from_slice(&((end - payload) as u64).to_le_bytes());
    let checksum = crc32fast::hash(&bytes[..end]).to_le_bytes();
    bytes[end..].copy_from_slice(&checksum);
}

/// The mode in a serialized state.
fn mode(bytes: &[u8]) -> Mode {
    use Mode::{
        ContinuousTime, Error, Event, Fatal, Initialization, Instantiated, StepComplete, StepFailed, Terminated,
    };
    let all = [Instantiated, Initialization, Event, ContinuousTime, StepComplete, StepFailed, Terminated, Error, Fatal];
    let number = super::host::mode_in(bytes);
    *all.iter().find(|mode| **mode as u16 == number).expect("a mode")
}
