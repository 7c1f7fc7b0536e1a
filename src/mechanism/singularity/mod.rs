//! Direct kinematic singularities (section 2.2).
//!
//! Three equivalent tests of the same surface in (heave, tilt_x, tilt_y): det A = 0 of the loop
//! closure (Appendix B), F(d_ave) = 0 of the cubic in the heave (Appendix C), and sigma_min = 0 of
//! the overall Jacobian. They are tied by an identity that holds at every pose:
//! `det J = -a^6 / (8 r_b^3) det A / (d_1 d_2 d_3)`, with det A = 8 F of lengths divided by a.

mod closure;
mod cubic;
mod distance;
mod roots;

pub use closure::{matrix_a, matrix_b, normalized_det_a};
pub use cubic::{SingularityCubic, singular_heights};
pub use distance::{NearestSingularity, nearest_singularity};
pub use roots::RealRoots;
