//! Geometry and kinematics of the 3-RPS mechanism.
//!
//! Frames and signs: the base frame's origin is the centre of the base circle, z points up. Limb
//! `i` stands in the vertical plane of azimuth 0, 120, 240 deg with radial unit vector `e_i`; its
//! revolute joint is A_i = a e_i, its spherical joint B_i = (a - d_i cos theta_i) e_i + d_i sin theta_i z.
//! P is the centre of the spherical joints; the generalized coordinates are
//! s = (heave, tilt_x, tilt_y), with P_z = heave and the orientation R = exp([tilt_x, tilt_y, 0]x).
#![forbid(unsafe_code)]

mod geometry;
mod jacobian;
mod limb;
mod pose;
mod rotation;
mod singular_value;
mod singularity;

pub use geometry::Geometry;
pub use jacobian::{OverallJacobian, scale_twist};
pub use limb::{Limb, LimbMotion};
pub use pose::{Pose, PoseMotion};
pub use rotation::{ExponentialCoefficients, rotation_vector};
pub use singular_value::SingularValues;
pub use singularity::{
    NearestSingularity, RealRoots, SingularityCubic, matrix_a, matrix_b, nearest_singularity, normalized_det_a,
    singular_heights,
};
