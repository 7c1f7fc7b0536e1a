//! Many instances, many threads (section 2.1.1).

use rps3::fmi2::types::Status;

use crate::host::{CoSimulation, Host};
use crate::toy::real;

fn run(stiffness: f64) -> Vec<u64> {
    let host = Host::new(CoSimulation);
    assert_eq!(host.set_real(real::K, stiffness), Status::Ok);
    host.initialize();
    for n in 0..100 {
        assert_eq!(host.step(f64::from(n) * 0.01, 0.01), Status::Ok);
    }
    host.fingerprint()
}

#[test]
fn instances_on_many_threads_give_the_bits_of_serial_runs() {
    let serial: Vec<_> = (0..16).map(|i| run(f64::from(i))).collect();
    let parallel: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..16).map(|i| scope.spawn(move || run(f64::from(i)))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert_eq!(parallel, serial);
}

#[test]
fn interleaved_instances_do_not_see_each_other() {
    let (a, b) = (Host::initialized(CoSimulation), Host::initialized(CoSimulation));
    assert_eq!(b.set_real(real::U, 50.0), Status::Ok);
    for n in 0..10 {
        let point = f64::from(n) * 0.05;
        assert_eq!((a.step(point, 0.05), b.step(point, 0.05)), (Status::Ok, Status::Ok));
    }
    let alone = Host::initialized(CoSimulation);
    for n in 0..10 {
        assert_eq!(alone.step(f64::from(n) * 0.05, 0.05), Status::Ok);
    }
    assert_eq!(a.fingerprint(), alone.fingerprint());
    assert_ne!(b.fingerprint(), alone.fingerprint());
}

#[test]
fn two_thousand_instances_live_in_one_process() {
    let hosts: Vec<Host> = (0..2000).map(|_| Host::initialized(CoSimulation)).collect();
    assert!(hosts.iter().all(|host| host.step(0.0, 0.01) == Status::Ok));
}
