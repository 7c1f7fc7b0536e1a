//! The objective as argmin wants it, and a point type of argmin's that does not allocate.

use std::marker::PhantomData;

use argmin::core::{CostFunction, Error};
use argmin_math::{ArgminAdd, ArgminMinMax, ArgminMul, ArgminRandom, ArgminSub, ArgminZeroLike};
use rand_0_9::Rng;

/// The objective of all swarms.
pub fn bowl(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum()
}

/// [`bowl`] for argmin, over positions `P`.
pub struct Bowl<P>(PhantomData<P>);

impl<P> Default for Bowl<P> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<P: AsRef<[f64]>> CostFunction for Bowl<P> {
    type Param = P;
    type Output = f64;

    fn cost(&self, x: &P) -> Result<f64, Error> {
        Ok(bowl(x.as_ref()))
    }
}

/// A position or velocity.
#[derive(Debug, Clone, Copy)]
pub struct Point<const D: usize>(pub [f64; D]);

impl<const D: usize> Point<D> {
    fn zip(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|g| f(self.0[g], other.0[g])))
    }
}

impl<const D: usize> AsRef<[f64]> for Point<D> {
    fn as_ref(&self) -> &[f64] {
        &self.0
    }
}

impl<const D: usize> ArgminAdd<Self, Self> for Point<D> {
    fn add(&self, other: &Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl<const D: usize> ArgminSub<Self, Self> for Point<D> {
    fn sub(&self, other: &Self) -> Self {
        self.zip(other, |a, b| a - b)
    }
}

impl<const D: usize> ArgminMul<f64, Self> for Point<D> {
    fn mul(&self, factor: &f64) -> Self {
        Self(self.0.map(|x| x * factor))
    }
}

impl<const D: usize> ArgminZeroLike for Point<D> {
    fn zero_like(&self) -> Self {
        Self([0.0; D])
    }
}

impl<const D: usize> ArgminMinMax for Point<D> {
    fn min(x: &Self, y: &Self) -> Self {
        x.zip(y, f64::min)
    }

    fn max(x: &Self, y: &Self) -> Self {
        x.zip(y, f64::max)
    }
}

impl<const D: usize> ArgminRandom for Point<D> {
    fn rand_from_range<R: Rng>(min: &Self, max: &Self, rng: &mut R) -> Self {
        Self(std::array::from_fn(|g| min.0[g] + rng.random::<f64>() * (max.0[g] - min.0[g])))
    }
}
