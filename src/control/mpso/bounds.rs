//! The box a swarm searches.

use super::SettingsError;

/// A box in `D` dimensions, in the units of its members. A member with equal bounds stays fixed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds<const D: usize> {
    lower: [f64; D],
    upper: [f64; D],
}

impl<const D: usize> Bounds<D> {
    /// The box from `lower` to `upper`, both included.
    ///
    /// # Errors
    /// [`SettingsError::Bounds`] for the first member with `lower > upper` or an infinite range.
    pub fn new(lower: [f64; D], upper: [f64; D]) -> Result<Self, SettingsError> {
        for (member, (&lower, &upper)) in lower.iter().zip(&upper).enumerate() {
            // An infinite or undefined bound makes the width infinite or NaN.
            if !((upper - lower).is_finite() && lower <= upper) {
                return Err(SettingsError::Bounds { member, lower, upper });
            }
        }
        Ok(Self { lower, upper })
    }

    /// Lower bounds.
    pub fn lower(&self) -> &[f64; D] {
        &self.lower
    }

    /// Upper bounds.
    pub fn upper(&self) -> &[f64; D] {
        &self.upper
    }

    /// Width of each member's range.
    pub(super) fn width(&self) -> [f64; D] {
        std::array::from_fn(|g| self.upper[g] - self.lower[g])
    }

    /// The point of the box nearest to `x`.
    pub(super) fn clamp(&self, x: &[f64; D]) -> [f64; D] {
        std::array::from_fn(|g| x[g].clamp(self.lower[g], self.upper[g]))
    }
}
