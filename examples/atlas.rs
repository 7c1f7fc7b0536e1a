//! The surface of direct singularities as CSV: for every tilt and direction of the platform all
//! singular heaves, the limbs there, and whether the pose lies within the joint limits.
//!
//! `cargo xtask atlas` runs this and draws the table.

use std::io::{BufWriter, Write};

use nalgebra::Vector3;
use rps3::defaults::{BASE_RADIUS, D_MAX, D_MIN, DEG, JOINT_SPACING, THETA_MAX, THETA_MIN};
use rps3::mechanism::{Geometry, Limb, Pose, nearest_singularity, singular_heights};

/// Sampled tilts and directions, deg. The mechanism looks the same from its three limbs, so 120 deg
/// of direction say everything; all of them make the surface easier to draw.
const TILTS: (usize, f64) = (61, 0.5);
const DIRECTIONS: (usize, f64) = (121, 3.0);
/// Home pose, m; the distance to it says how deep in the workspace a singular pose lies.
const HOME_HEAVE: f64 = 0.05;

fn main() -> std::io::Result<()> {
    let geometry = Geometry::new(BASE_RADIUS, JOINT_SPACING);
    let mut out = BufWriter::new(std::io::stdout().lock());
    writeln!(
        out,
        "tilt_deg,direction_deg,sheet,heave_m,d1_m,d2_m,d3_m,theta1_deg,theta2_deg,theta3_deg,within_limits"
    )?;
    for tilt in (0..TILTS.0).map(|k| k as f64 * TILTS.1) {
        for direction in (0..DIRECTIONS.0).map(|k| k as f64 * DIRECTIONS.1) {
            let (sin, cos) = (direction * DEG).sin_cos();
            let (tilt_x, tilt_y) = (tilt * DEG * cos, tilt * DEG * sin);
            for (sheet, &heave) in singular_heights(&geometry, tilt_x, tilt_y).iter().enumerate() {
                let limbs = Limb::all(&geometry, &Pose::new(&geometry, &Vector3::new(heave, tilt_x, tilt_y)));
                let [d1, d2, d3] = limbs.map(|limb| limb.length);
                let [t1, t2, t3] = limbs.map(|limb| limb.angle() / DEG);
                let within = limbs.iter().all(|limb| {
                    (D_MIN..=D_MAX).contains(&limb.length) && (THETA_MIN..=THETA_MAX).contains(&limb.angle())
                });
                writeln!(
                    out,
                    "{tilt},{direction},{sheet},{heave:.12},{d1:.12},{d2:.12},{d3:.12},{t1:.9},{t2:.9},{t3:.9},{}",
                    u8::from(within)
                )?;
            }
        }
    }
    let home = nearest_singularity(&geometry, &Vector3::new(HOME_HEAVE, 0.0, 0.0));
    eprintln!("the home pose is {:.2} mm from the nearest singular one", 1e3 * home.distance);
    out.flush()
}
