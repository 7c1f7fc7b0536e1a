//! A short soak; `cargo xtask soak` is the long one.

mod common;

use common::soak::{Window, random_crossings, to_and_fro};

/// The first window fills what is allocated once; the others are compared. Errors in m.
fn check(windows: &[Window], peak_error: f64, end_error: f64) {
    assert!(windows.iter().all(|w| w.failed_steps == 0 && w.faults == 0), "{windows:?}");
    assert!(windows.iter().all(|w| w.peak_error < peak_error && w.end_error < end_error), "{windows:?}");
    let resident: Vec<_> = windows[1..].iter().filter_map(|w| w.resident).collect();
    if let (Some(first), Some(last)) = (resident.first(), resident.last()) {
        // another test of this binary may run beside it; a leak of 100 B a step would be above this
        assert!(last.saturating_sub(*first) < 1024, "{windows:?}");
    }
}

#[test]
fn to_and_fro_through_the_singular_pose_nothing_wears_out() {
    // fixed damping gives accuracy away, the swarm finds how little will do
    for (mode, peak_error, end_error) in [(3, 20e-3, 3e-3), (4, 1e-3, 1e-4)] {
        let mut windows = Vec::new();
        to_and_fro(mode, 4, 3, |window| windows.push(*window));
        check(&windows, peak_error, end_error);
        // every lap is the first again: errors do not add up
        let worst = windows[1..].iter().map(|w| w.peak_error).fold(0.0, f64::max);
        assert!(worst < 1.1 * windows[0].peak_error, "{windows:?}");
    }
}

#[test]
fn random_crossings_follow_each_other_in_the_same_instances() {
    let mut windows = Vec::new();
    random_crossings(4, 4, 3, |window| windows.push(*window));
    check(&windows, 5e-3, 1e-4);
    assert_eq!(windows.iter().map(|w| w.crossings).sum::<u32>(), 12);
}
