//! Direct singularities: loop closure, Appendices B and C, the cubic against determinants and
//! singular values, and what the paper prints wrong about them.

use nalgebra::{Matrix3, Vector3};
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;
use rps3::defaults::{BASE_RADIUS, JOINT_SPACING};
use rps3::mechanism::{
    Geometry, Limb, OverallJacobian, Pose, RealRoots, SingularityCubic, matrix_a, matrix_b, nearest_singularity,
    normalized_det_a, singular_heights,
};
use rps3::scalar::Scalar;

const DEG: f64 = std::f64::consts::PI / 180.0;

fn geometry<T: Scalar>() -> Geometry<T> {
    Geometry::new(BASE_RADIUS.into(), JOINT_SPACING.into())
}

fn tilted(heave: f64, tilt: f64, direction: f64) -> Vector3<f64> {
    let (sin, cos) = (direction * DEG).sin_cos();
    Vector3::new(heave, tilt * DEG * cos, tilt * DEG * sin)
}

fn limbs(geometry: &Geometry<f64>, s: &Vector3<f64>) -> [Limb<f64>; 3] {
    Limb::all(geometry, &Pose::new(geometry, s))
}

/// e_i (2.7) and h_i (2.8) of a pose, lengths divided by a.
fn direction_of(geometry: &Geometry<f64>, limbs: &[Limb<f64>; 3]) -> ([f64; 3], [f64; 3]) {
    let a = geometry.base_radius;
    let e = limbs.map(|limb| 1.0 - limb.length * limb.cos / a);
    let z = limbs.map(|limb| limb.length * limb.sin / a);
    (e, [z[2] - z[1], z[0] - z[2], z[1] - z[0]])
}

/// Omega_4 as Appendix C prints it.
fn printed_omega_4([e1, e2, e3]: [f64; 3], [h1, h2, h3]: [f64; 3]) -> f64 {
    let square = |x: f64| x * x;
    let g = e1 * (e2 * e3 - e2 - e3 + 4.0) + e2 * (e1 * e3 - e1 - e3 + 4.0) + e3 * (e1 * e2 - e1 - e2 + 4.0);
    -16.0 / 9.0
        * ((h1 * h2 * (h2 - h1) + h2 * h3 * (h3 - h2) + h3 * h1 * (h1 - h3)) * g
            + 3.0 * e2 * e3 * square(h2 - h3) * (h3 - h1) * (e3 - 1.0)
            + 3.0 * e2 * e3 * square(h2 - h3) * (h1 - h2) * (e2 - 1.0)
            + 3.0 * e1 * e3 * square(h3 - h1) * (h2 - h3) * (e3 - 1.0)
            + 3.0 * e1 * e3 * square(h3 - h1) * (h1 - h2) * (e1 - 1.0)
            + 3.0 * e1 * e2 * square(h1 - h2) * (h2 - h3) * (e2 - 1.0)
            + 3.0 * e1 * e2 * square(h1 - h2) * (h3 - h1) * (e1 - 1.0))
}

proptest! {
    #[test]
    fn loop_closure_is_kept_along_any_motion(
        heave in -0.1..0.2, tilt in 0.0..40.0, direction in 0.0..360.0, rates in prop::array::uniform3(-2.0..2.0),
    ) {
        // (2.5) = 0 with Appendix B as printed: angles outwards, lengths divided by a
        let g = geometry::<f64>();
        let (s, s_dot) = (tilted(heave, tilt, direction), Vector3::from(rates));
        let pose = Pose::new(&g, &s);
        let motion = pose.motion(&g, &s_dot);
        let limbs = Limb::all(&g, &pose);
        let motions = limbs.map(|limb| limb.motion(&motion, &s_dot));
        let theta_dot = Vector3::from_fn(|i, _| -motions[i].angle_rate);
        let d_dot = Vector3::from_fn(|i, _| motions[i].length_rate / g.base_radius);
        let residual = matrix_a(&g, &limbs) * theta_dot + matrix_b(&g, &limbs) * d_dot;
        prop_assert!(residual.amax() < 1e-13, "{residual}");
    }

    #[test]
    fn matrices_are_the_derivatives_of_the_squared_joint_distances(
        heave in -0.1..0.2, tilt in 0.0..40.0, direction in 0.0..360.0,
    ) {
        // (2.4) in dual numbers, limb by limb: torn from the platform, each B_i moves alone
        let g = geometry::<f64>();
        let limbs = limbs(&g, &tilted(heave, tilt, direction));
        let distances = |angle: usize, length: usize| {
            let joints = [0, 1, 2].map(|i| {
                let outward = std::f64::consts::PI - limbs[i].angle();
                let seed = |k: usize| if k == i { 1.0 } else { 0.0 };
                let theta = Dual64::new(outward, seed(angle));
                let d = Dual64::new(limbs[i].length / g.base_radius, seed(length));
                g.radial[i].map(Dual64::from) * (d * theta.cos() + 1.0) + Vector3::z() * (d * theta.sin())
            });
            Vector3::from([(0, 1), (1, 2), (2, 0)].map(|(i, j)| (joints[i] - joints[j]).norm_squared().eps))
        };
        let none = 3;
        let a = Matrix3::from_columns(&[0, 1, 2].map(|i| distances(i, none)));
        let b = Matrix3::from_columns(&[0, 1, 2].map(|i| distances(none, i)));
        prop_assert!((a - matrix_a(&g, &limbs)).amax() < 1e-14);
        prop_assert!((b - matrix_b(&g, &limbs)).amax() < 1e-14);
    }

    #[test]
    fn cubic_is_an_eighth_of_det_a(
        heave in -0.2..0.3, tilt in 0.0..60.0, direction in 0.0..360.0,
    ) {
        let g = geometry::<f64>();
        let s = tilted(heave, tilt, direction);
        let f = SingularityCubic::at_tilt(&g, s.y, s.z).value(heave / g.base_radius);
        let det_a = normalized_det_a(&g, &limbs(&g, &s));
        prop_assert!((8.0 * f - det_a).abs() < 1e-13 * (1.0 + det_a.abs()), "{f} {det_a}");
    }

    #[test]
    fn det_a_and_the_overall_jacobian_s_determinant_are_proportional(
        heave in -0.2..0.3, tilt in 0.0..60.0, direction in 0.0..360.0,
        base_radius in 0.2..2.0, joint_spacing in 0.1..2.0,
    ) {
        // hence det A = 0 exactly where sigma_min(J) = 0
        let g = Geometry::new(base_radius, joint_spacing);
        let limbs = limbs(&g, &tilted(heave, tilt, direction));
        prop_assume!(limbs.iter().all(|limb| limb.length > 0.01));
        let lengths: f64 = limbs.iter().map(|limb| limb.length / g.base_radius).product();
        let det_j = OverallJacobian::new(&g, &limbs).matrix.determinant();
        let ratio = (g.base_radius / g.joint_radius).powi(3);
        let expected = -0.125 * ratio * normalized_det_a(&g, &limbs) / lengths;
        prop_assert!((det_j - expected).abs() < 1e-12 * (1.0 + ratio / lengths), "{det_j} {expected}");
    }

    #[test]
    fn all_measures_vanish_at_the_cubic_s_roots(tilt in 0.5..40.0, direction in 0.0..360.0) {
        let g = geometry::<f64>();
        let t = tilted(0.0, tilt, direction);
        let cubic = SingularityCubic::at_tilt(&g, t.y, t.z);
        let heights = singular_heights(&g, t.y, t.z);
        prop_assert!(heights.len() == 1 || heights.len() == 3);
        for &heave in heights.iter() {
            let limbs = limbs(&g, &Vector3::new(heave, t.y, t.z));
            prop_assert!(normalized_det_a(&g, &limbs).abs() < 1e-12);
            let sigma = OverallJacobian::new(&g, &limbs).sigma_min();
            prop_assert!(sigma < 1e-12, "{sigma:e}");
            prop_assert!(cubic.value(heave / g.base_radius).abs() < 1e-12);
        }
    }

    #[test]
    fn roots_are_where_det_a_changes_its_sign_and_nowhere_else(tilt in 0.5..40.0, direction in 0.0..360.0) {
        let g = geometry::<f64>();
        let t = tilted(0.0, tilt, direction);
        let det_a = |heave: f64| normalized_det_a(&g, &limbs(&g, &Vector3::new(heave, t.y, t.z)));
        let heights = singular_heights(&g, t.y, t.z);
        let closest = heights.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::MAX, f64::min);
        prop_assume!(closest > 1e-3);
        // a mesh finer than the roots' spacing over all heaves of interest
        let mesh: Vec<f64> = (-1500..1500).map(|k| (k as f64 + 0.5) * 4e-4).collect();
        let mut found = Vec::new();
        for pair in mesh.windows(2) {
            let (mut low, mut high) = (pair[0], pair[1]);
            if det_a(low) * det_a(high) < 0.0 {
                while high - low > 1e-15 {
                    let middle = 0.5 * (low + high);
                    if middle == low || middle == high { break }
                    if det_a(low) * det_a(middle) <= 0.0 { high = middle } else { low = middle }
                }
                found.push(0.5 * (low + high));
            }
        }
        let within: Vec<f64> = heights.iter().copied().filter(|h| h.abs() < 0.599).collect();
        prop_assert_eq!(found.len(), within.len(), "{:?} {:?}", found, within);
        for (f, w) in found.iter().zip(within) {
            // both solve the same cubic, whose condition is the inverse of the roots' spacing
            prop_assert!((f - w).abs() < 1e-12 * (1.0 + (1e-2 / closest).powi(2)), "{} {}", f, w);
        }
    }

    #[test]
    fn nearest_singular_pose_is_singular_and_the_offset_to_it_normal_to_the_surface(
        heave in -0.05..0.15, tilt in 1.0..20.0, direction in 0.0..360.0,
    ) {
        let g = geometry::<f64>();
        let s = tilted(heave, tilt, direction);
        let nearest = nearest_singularity(&g, &s);
        let scale = |v: Vector3<f64>| Vector3::new(v.x, v.y * g.joint_radius, v.z * g.joint_radius);
        let offset = scale(s - nearest.pose);
        prop_assert!((offset.norm() - nearest.distance).abs() < 1e-15);
        let gd = geometry::<Dual64>();
        let gradient = Vector3::from_fn(|k, _| {
            let mut x = nearest.pose.map(Dual64::from);
            x[k].eps = 1.0;
            normalized_det_a(&gd, &Limb::all(&gd, &Pose::new(&gd, &x))).eps
        });
        prop_assert!(normalized_det_a(&g, &limbs(&g, &nearest.pose)).abs() < 1e-12);
        // covector in scaled coordinates; at the cone of the flat pose there is no normal
        let normal = Vector3::new(gradient.x, gradient.y / g.joint_radius, gradient.z / g.joint_radius);
        if normal.norm() > 1e-3 && nearest.distance > 1e-6 {
            let sine = normal.normalize().cross(&offset.normalize()).norm();
            prop_assert!(sine < 1e-5, "{sine:e}");
        }
    }
}

#[test]
fn no_singular_pose_is_nearer_than_the_nearest() {
    let g = geometry::<f64>();
    let surface: Vec<Vector3<f64>> = (0..120)
        .flat_map(|i| (0..180).map(move |j| (i as f64 * 0.5, j as f64 * 2.0)))
        .flat_map(|(tilt, direction)| {
            let t = tilted(0.0, tilt, direction);
            singular_heights(&geometry(), t.y, t.z).iter().map(|&h| Vector3::new(h, t.y, t.z)).collect::<Vec<_>>()
        })
        .collect();
    for (heave, tilt, direction) in
        [(0.05, 0.0, 0.0), (0.05, 8.0, 40.0), (0.07, 15.0, 200.0), (0.1, 3.0, 90.0), (-0.04, 12.0, 300.0)]
    {
        let s = tilted(heave, tilt, direction);
        let distance = |p: &Vector3<f64>| {
            ((p.x - s.x).powi(2) + g.joint_radius.powi(2) * ((p.y - s.y).powi(2) + (p.z - s.z).powi(2))).sqrt()
        };
        let sampled = surface.iter().map(distance).fold(f64::MAX, f64::min);
        let nearest = nearest_singularity(&g, &s).distance;
        // the sample is 0.5 deg by 2 deg coarse: some mm at most
        assert!(nearest <= sampled && sampled < nearest + 4e-3, "{nearest} {sampled}");
    }
}

#[test]
fn a_flat_platform_is_singular_at_the_base_s_height_and_there_only() {
    // so the paper's starting point P = (0, 0, 0) (section 6.1) is itself a singular pose
    assert_eq!(&*singular_heights(&geometry(), 0.0, 0.0), &[0.0; 3]);
}

#[test]
fn known_singular_heights() {
    let g = geometry();
    let t = tilted(0.0, 8.0, 40.0);
    // ten printed decimals
    assert!(singular_heights(&g, t.y, t.z).iter().any(|h| (h - 0.0452873763).abs() < 5e-11));
    let t = tilted(0.0, 10.0, 30.0);
    for (found, expected) in singular_heights(&g, t.y, t.z).iter().zip([-0.0738, 0.0181, 0.0546]) {
        assert!((found - expected).abs() < 5e-5, "{found} {expected}");
    }
}

#[test]
fn printed_omega_4_is_wrong() {
    // errata: at the true singular pose of the default crossing the cubic with the printed
    // Omega_4 does not vanish, and its root misses by millimetres or more
    let g = geometry::<f64>();
    let s = tilted(0.0452873763, 8.0, 40.0);
    let (e, h) = direction_of(&g, &limbs(&g, &s));
    let right = SingularityCubic::new(e, h);
    let mut printed = right;
    printed.omega[3] = printed_omega_4(e, h);
    let d_ave = s.x / g.base_radius;
    // ten decimals of the heave are given
    assert!(right.value(d_ave).abs() < 1e-10);
    assert!(printed.value(d_ave).abs() > 1e-3, "{:e}", printed.value(d_ave));
    let miss =
        RealRoots::of_cubic(printed.omega).iter().map(|x| (x * g.base_radius - s.x).abs()).fold(f64::MAX, f64::min);
    assert!(miss > 1e-3, "{miss}");
}

#[test]
fn no_common_factor_repairs_the_printed_omega_4() {
    // the ratio of the true to the printed coefficient changes with the direction: the terms are wrong
    // (3 e_k where x^2 + x - 2 = (x - 1)(x + 2) gives e_k + 2), not the factor before them alone
    let g = geometry::<f64>();
    let ratios: Vec<f64> = [(8.0, 40.0), (20.0, 10.0), (15.0, 75.0), (30.0, 200.0)]
        .into_iter()
        .map(|(tilt, direction)| {
            let (e, h) = direction_of(&g, &limbs(&g, &tilted(0.05, tilt, direction)));
            SingularityCubic::new(e, h).omega[3] / printed_omega_4(e, h)
        })
        .collect();
    let (low, high) = ratios.iter().fold((f64::MAX, f64::MIN), |(l, h), &r| (l.min(r), h.max(r)));
    assert!(high - low > 0.02 * high.abs(), "{ratios:?}");
}

#[test]
fn printed_cubic_is_det_a_over_eight_not_det_a() {
    // errata: (2.11) equates them; Omega_1 at e_i = 1 alone shows the factor
    let cubic = SingularityCubic::new([1.0; 3], [0.0; 3]);
    // vertical limbs of length a: each a_ij of (B.1) is -3, so det A = 2 (-3)^3
    assert_eq!(cubic.omega, [-6.75, 0.0, 0.0, 0.0]);
    let element = 2.0 * (-0.5 * 1.0 - 1.0);
    assert_eq!(2.0 * f64::powi(element, 3), 8.0 * cubic.value(1.0));
}

#[test]
fn direct_singularities_lie_well_inside_the_joint_limits() {
    // against the introduction, which calls them the boundary of the workspace
    let g = geometry::<f64>();
    let limbs = limbs(&g, &tilted(0.0452873763, 8.0, 40.0));
    for limb in limbs {
        use rps3::defaults::{D_MAX, D_MIN, THETA_MAX, THETA_MIN};
        assert!(limb.length > D_MIN + 0.05 && limb.length < D_MAX - 0.05);
        assert!(limb.angle() > THETA_MIN + 0.05 && limb.angle() < THETA_MAX - 0.05);
    }
}

#[test]
fn the_paper_s_straight_path_would_need_a_tilt_of_71_degrees() {
    // section 6.1: P moves to (5, -5, 5) cm; the parasitic motion reaches r_b/2 (1 - cos tilt) only
    let g = geometry::<f64>();
    let reach = |tilt: f64, direction: f64| Pose::new(&g, &tilted(0.05, tilt, direction)).position.xy().norm();
    let wanted = 0.05 * 2.0_f64.sqrt();
    let tilt = (1.0 - 2.0 * wanted / g.joint_radius).acos() / DEG;
    assert!((tilt - 71.2).abs() < 0.1, "{tilt}");
    for direction in [0.0, 33.0, 170.0] {
        assert!((reach(tilt, direction) - wanted).abs() < 1e-15);
    }
    assert!(reach(20.0, 45.0) < 0.0063);
}
