//! Distance of a pose to the surface of direct singularities.

use nalgebra::{Vector2, Vector3};

use super::super::Geometry;
use super::singular_heights;

/// The singular pose nearest to a given one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestSingularity {
    /// Its (heave, tilt_x, tilt_y) in (m, rad, rad).
    pub pose: Vector3<f64>,
    /// Euclidean distance in (heave, r_b tilt_x, r_b tilt_y), m.
    pub distance: f64,
}

/// Rings and spokes of the search for a start; the surface has at most three sheets above each
/// tilt, smooth but for the cone at the flat pose, so its valleys are wider than this mesh.
const RINGS: usize = 12;
const SPOKES: usize = 24;
/// Local searches from the best starts, in different valleys mostly.
const STARTS: usize = 4;
/// Halvings of the local search's step: the distance is stationary in the tilt, so that 2^-26 of
/// the first step leaves an error in it near the rounding error.
const HALVINGS: usize = 26;

/// The nearest singular pose to `s` = (heave in m, tilt_x, tilt_y in rad).
///
/// The surface is a graph over the tilt, of [`singular_heights`]. The one straight above or below
/// bounds the distance and so the tilts to look at: a mesh over that disc, then a compass search,
/// which needs no derivative at the surface's cone and folds.
pub fn nearest_singularity(geometry: &Geometry<f64>, s: &Vector3<f64>) -> NearestSingularity {
    let (heave, tilt) = (s.x, Vector2::new(s.y, s.z));
    let r_b = geometry.joint_radius;
    let at = |t: Vector2<f64>| {
        let offset = r_b * (t - tilt).norm();
        singular_heights(geometry, t.x, t.y)
            .iter()
            .map(|&height| NearestSingularity {
                pose: Vector3::new(height, t.x, t.y),
                distance: (height - heave).hypot(offset),
            })
            .min_by(|a, b| a.distance.total_cmp(&b.distance))
            .expect("a cubic has a real root")
    };
    let above_or_below = at(tilt);
    let radius = above_or_below.distance / r_b;
    let mesh = (1..=RINGS).flat_map(|ring| (0..SPOKES).map(move |spoke| (ring, spoke)));
    let mut starts: Vec<_> = mesh
        .map(|(ring, spoke)| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * spoke as f64 / SPOKES as f64);
            at(tilt + Vector2::new(cos, sin) * (radius * ring as f64 / RINGS as f64))
        })
        .chain([above_or_below])
        .collect();
    starts.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance));
    starts
        .into_iter()
        .take(STARTS)
        .map(|start| compass_search(start, radius / RINGS as f64, at))
        .min_by(|a, b| a.distance.total_cmp(&b.distance))
        .expect("there is a start")
}

/// Moves to the best of the neighbours at `step`, halves the step where none is better.
fn compass_search(
    mut best: NearestSingularity,
    mut step: f64,
    at: impl Fn(Vector2<f64>) -> NearestSingularity,
) -> NearestSingularity {
    const DIRECTIONS: [(f64, f64); 8] =
        [(1.0, 0.0), (0.7, 0.7), (0.0, 1.0), (-0.7, 0.7), (-1.0, 0.0), (-0.7, -0.7), (0.0, -1.0), (0.7, -0.7)];
    for _ in 0..HALVINGS {
        loop {
            let centre = Vector2::new(best.pose.y, best.pose.z);
            let neighbour = DIRECTIONS
                .map(|(x, y)| at(centre + Vector2::new(x, y) * step))
                .into_iter()
                .min_by(|a, b| a.distance.total_cmp(&b.distance))
                .expect("there are eight");
            if neighbour.distance >= best.distance {
                break;
            }
            best = neighbour;
        }
        step *= 0.5;
    }
    best
}
