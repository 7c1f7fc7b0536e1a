//! What a study needs beside the FMUs: crossings to drive, schemes to compare and figures of merit.
#![forbid(unsafe_code)]

mod baselines;
mod crossing;
mod figures;
mod parallel;
mod scheme;
mod trajectory;

pub use baselines::{PlatformComputedTorque, VariableDamping};
pub use crossing::Crossing;
pub use figures::{Distribution, Figures};
pub use parallel::in_parallel;
pub use scheme::{BASELINES, Law, MODES, Scheme};
pub use trajectory::{Sample, trajectory};
