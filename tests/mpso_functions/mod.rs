//! Standard test functions with known minima. Transcendental functions come from `libm`, so that
//! values are the same bits on every platform.
#![allow(dead_code, reason = "each program uses some of them")]

use std::f64::consts::{E, TAU};

/// A function of any dimension whose smallest value is 0.
pub struct Function {
    pub name: &'static str,
    /// Every member is searched from here ...
    pub lower: f64,
    /// ... to here.
    pub upper: f64,
    /// Less than the value at every local minimum but the global one, up to six dimensions: a
    /// search that ends below it has found the global basin.
    pub basin: f64,
    pub value: fn(&[f64]) -> f64,
}

/// Unimodal: the sum of squares about a point off the centre.
pub const SPHERE: Function = Function { name: "Sphere", lower: -5.0, upper: 10.0, basin: f64::INFINITY, value: sphere };
/// A paraboloid under a cosine lattice; the second-best minima are 0.995, one lattice step away.
pub const RASTRIGIN: Function = Function { name: "Rastrigin", lower: -5.12, upper: 5.12, basin: 0.9, value: rastrigin };
/// A nearly flat, rippled plain around a funnel; second best about 1.6 in six dimensions.
pub const ACKLEY: Function = Function { name: "Ackley", lower: -32.768, upper: 32.768, basin: 1.0, value: ackley };
/// The best minimum near a corner, the second best, 118.4, far from it: deceptive.
pub const SCHWEFEL: Function =
    Function { name: "Schwefel", lower: -500.0, upper: 500.0, basin: 100.0, value: schwefel };

pub const MULTIMODAL: [Function; 3] = [RASTRIGIN, ACKLEY, SCHWEFEL];

fn sphere(x: &[f64]) -> f64 {
    x.iter().map(|x| (x - 1.0) * (x - 1.0)).sum()
}

fn rastrigin(x: &[f64]) -> f64 {
    x.iter().map(|x| 10.0 + x * x - 10.0 * libm::cos(TAU * x)).sum()
}

fn ackley(x: &[f64]) -> f64 {
    let n = x.len() as f64;
    let square = x.iter().map(|x| x * x).sum::<f64>() / n;
    let cosine = x.iter().map(|x| libm::cos(TAU * x)).sum::<f64>() / n;
    20.0 - 20.0 * libm::exp(-0.2 * square.sqrt()) + E - libm::exp(cosine)
}

fn schwefel(x: &[f64]) -> f64 {
    x.iter().map(|x| 418.982_887_272_433_8 - x * libm::sin(x.abs().sqrt())).sum()
}
