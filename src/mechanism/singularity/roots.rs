//! Real roots of a cubic polynomial.

use std::ops::Deref;

/// Up to three real roots in ascending order; a double root counts twice.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RealRoots {
    values: [f64; 3],
    count: usize,
}

impl Deref for RealRoots {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

impl RealRoots {
    /// Of a x^3 + b x^2 + c x + d with `a` != 0.
    ///
    /// Newton's iteration from outside all roots, then deflation to a quadratic with a
    /// discriminant of full precision: W. Kahan, "To Solve a Real Cubic Equation", report PAM-352,
    /// University of California, Berkeley, 1986. Every root is exact for coefficients that differ
    /// from the given ones by a few units in the last place.
    pub fn of_cubic(coefficients: [f64; 4]) -> Self {
        let [a, b, c, d] = coefficients;
        let (outer, linear, constant) = deflate(a, b, c, d);
        let mut roots = Self { values: [outer, 0.0, 0.0], count: 1 };
        // a x^2 + linear x + constant
        let half = -0.5 * linear;
        let discriminant = difference_of_products(half, half, a, constant);
        if discriminant >= 0.0 {
            let sum = half + discriminant.sqrt().copysign(half);
            roots.values[1] = sum / a;
            roots.values[2] = if sum == 0.0 { 0.0 } else { constant / sum };
            roots.count = 3;
        }
        roots.values[..roots.count].sort_unstable_by(f64::total_cmp);
        roots
    }

    /// The roots times a positive `factor`.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.values = self.values.map(|x| x * factor);
        self
    }
}

/// The outermost real root x and the quadratic a x^2 + linear x + constant that the others solve.
fn deflate(a: f64, b: f64, c: f64, d: f64) -> (f64, f64, f64) {
    let evaluate = |x: f64| {
        let ax = a * x;
        let linear = ax + b;
        let constant = linear * x + c;
        (constant * x + d, (ax + linear) * x + constant, linear, constant)
    };
    // the inflection point tells on which side the single outer root lies
    let mut x = -(b / a) / 3.0;
    let (value, slope, mut linear, mut constant) = evaluate(x);
    let ratio = value / a;
    let side = if ratio < 0.0 { -1.0 } else { 1.0 };
    let mut reach = libm::cbrt(ratio.abs());
    let steepness = -slope / a;
    if steepness > 0.0 {
        // the real root of x^3 = x + 1 bounds the outer root's distance
        reach = 1.324_717_957_244_79 * reach.max(steepness.sqrt());
    }
    let mut next = x - side * reach;
    if next == x {
        return (x, linear, constant);
    }
    // Newton's iteration from outside is monotonic; it has converged when it would turn back
    loop {
        x = next;
        let (value, slope, l, c2) = evaluate(x);
        (linear, constant) = (l, c2);
        next = if slope == 0.0 { x } else { x - value / slope / (1.0 + f64::EPSILON) };
        if side * next <= side * x {
            break;
        }
    }
    // deflate from the end that loses less
    if a.abs() * x * x > (d / x).abs() {
        constant = -d / x;
        linear = (constant - c) / x;
    }
    (x, linear, constant)
}

/// a b - c d with one rounding error of the result (Kahan's fused multiply-add formula).
fn difference_of_products(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let product = c * d;
    let error = libm::fma(c, d, -product);
    libm::fma(a, b, -product) - error
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn from_roots(r: [f64; 3], scale: f64) -> [f64; 4] {
        [1.0, -(r[0] + r[1] + r[2]), r[0] * r[1] + r[1] * r[2] + r[2] * r[0], -r[0] * r[1] * r[2]].map(|x| x * scale)
    }

    proptest! {
        #[test]
        fn separate_roots_come_back(low in -3.0..3.0_f64, gaps in prop::array::uniform2(0.1..2.0_f64), scale in -9.0..9.0_f64) {
            prop_assume!(scale != 0.0);
            let expected = [low, low + gaps[0], low + gaps[0] + gaps[1]];
            let found = RealRoots::of_cubic(from_roots(expected, scale));
            prop_assert_eq!(found.len(), 3);
            for (f, e) in found.iter().zip(expected) {
                // rounding of the coefficients over the smallest slope
                prop_assert!((f - e).abs() < 1e-11, "{} {}", f, e);
            }
        }

        #[test]
        fn one_real_root_beside_a_complex_pair(root in -3.0..3.0_f64, re in -3.0..3.0_f64, im in 0.1..3.0_f64) {
            let (p, q) = (-2.0 * re, re * re + im * im);
            let found = RealRoots::of_cubic([1.0, p - root, q - p * root, -q * root]);
            prop_assert_eq!(found.len(), 1);
            prop_assert!((found[0] - root).abs() < 1e-11);
        }
    }

    #[test]
    fn multiple_roots_are_found_exactly_where_the_coefficients_are() {
        assert_eq!(&*RealRoots::of_cubic([-9.0, 0.0, 0.0, 0.0]), &[0.0, 0.0, 0.0]);
        assert_eq!(&*RealRoots::of_cubic(from_roots([1.0, 1.0, 1.0], 1.0)), &[1.0, 1.0, 1.0]);
        assert_eq!(&*RealRoots::of_cubic(from_roots([-2.0, 1.0, 1.0], 3.0)), &[-2.0, 1.0, 1.0]);
        assert_eq!(&*RealRoots::of_cubic([1.0, 0.0, -1.0, 0.0]), &[-1.0, 0.0, 1.0]);
    }
}
