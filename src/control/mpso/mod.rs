//! Modified particle swarm optimization (MPSO), section 3 of the paper.
//!
//! A [`Swarm`] minimizes a function of `D` members over a box. Every iteration moves each of the
//! PS individuals once (3.1); parents and offspring form a combined population of 2 PS, of which
//! those with the smallest fitness score survive,
//!
//! ```text
//! F_k = RE_k + s RD_k                                                          (3.3)
//! ```
//!
//! where `RE_k` ranks the error (1 = smallest) and `RD_k` the distance to the best solution
//! (1 = farthest), so that a good individual far away can beat a slightly better one next to the
//! best. The decay scale `s` shrinks while the search makes no progress (3.5): first diversify,
//! then intensify. (The paper calls it rho, as it calls the damping factor.)
//!
//! How the open points of the paper are settled, and what the modification is worth:
//! `docs/mpso.md`.
//!
//! Searching never allocates, and the same settings, generator state, warm start and objective
//! give the same bits on every platform.

mod bounds;
mod particle;
mod rank;
mod schedule;
mod settings;
mod swarm;

pub use bounds::Bounds;
pub use schedule::{DecaySchedule, inertia};
pub use settings::{Selection, Settings, SettingsError};
pub use swarm::{Progress, Solution, Swarm};
