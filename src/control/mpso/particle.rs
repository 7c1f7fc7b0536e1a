//! One individual and its move (3.1).

use rand::Rng;

use super::{Bounds, Settings};

/// An individual: where it is, how it moves and the best position of its line of descent.
#[derive(Debug, Clone, Copy)]
pub(super) struct Particle<const D: usize> {
    pub position: [f64; D],
    /// Of the present position.
    pub error: f64,
    velocity: [f64; D],
    best_position: [f64; D],
    best_error: f64,
}

/// What all individuals have in common in the moves of one search.
#[derive(Debug, Clone)]
pub(super) struct Motion<const D: usize> {
    pub bounds: Bounds<D>,
    width: [f64; D],
    velocity_max: [f64; D],
    c1: f64,
    c2: f64,
}

impl<const D: usize> Motion<D> {
    pub fn new(bounds: Bounds<D>, settings: &Settings) -> Self {
        let width = bounds.width();
        let velocity_max = width.map(|w| settings.velocity_limit * w);
        Self { bounds, width, velocity_max, c1: settings.c1, c2: settings.c2 }
    }

    /// An individual at a random place with a random velocity.
    pub fn scatter(&self, rng: &mut impl Rng) -> Particle<D> {
        let mut particle = Particle::default();
        for g in 0..D {
            let (r1, r2) = two_uniforms(rng);
            // Rounding must not lead out of the box.
            particle.position[g] = (self.bounds.lower()[g] + r1 * self.width[g]).min(self.bounds.upper()[g]);
            particle.velocity[g] = (2.0 * r2 - 1.0) * self.velocity_max[g];
        }
        particle
    }

    /// Makes `child` the individual that `parent` becomes by one move under inertia `w`. It inherits
    /// the parent's best; [`Particle::remember`] then compares its own error.
    pub fn beget(&self, parent: &Particle<D>, child: &mut Particle<D>, best: &[f64; D], w: f64, rng: &mut impl Rng) {
        for (g, &attractor) in best.iter().enumerate() {
            let (r1, r2) = two_uniforms(rng);
            let x = parent.position[g];
            let pull = self.c1 * r1 * (parent.best_position[g] - x) + self.c2 * r2 * (attractor - x);
            let velocity = limit(w * parent.velocity[g] + pull, -self.velocity_max[g], self.velocity_max[g]); // (3.1)
            let free = x + velocity; // (3.1)
            child.position[g] = limit(free, self.bounds.lower()[g], self.bounds.upper()[g]);
            child.velocity[g] = if child.position[g] == free { velocity } else { 0.0 };
        }
        child.best_position = parent.best_position;
        child.best_error = parent.best_error;
    }
}

impl<const D: usize> Particle<D> {
    /// Puts a fresh individual somewhere else, at rest: what is known to be good is searched from close by.
    pub fn place(&mut self, position: [f64; D]) {
        self.position = position;
        self.velocity = [0.0; D];
    }

    /// Takes note of the error at the present position: pbest of (3.1).
    pub fn remember(&mut self, error: f64) {
        self.error = error;
        if error < self.best_error {
            self.best_error = error;
            self.best_position = self.position;
        }
    }
}

impl<const D: usize> Default for Particle<D> {
    fn default() -> Self {
        Self {
            position: [0.0; D],
            error: f64::INFINITY,
            velocity: [0.0; D],
            best_position: [0.0; D],
            best_error: f64::INFINITY,
        }
    }
}

/// Two independent uniform numbers in [0, 1) from one draw: Rand() and Rand*() of (3.1). 32 bits
/// each are far more than a search of some hundred points can tell apart.
fn two_uniforms(rng: &mut impl Rng) -> (f64, f64) {
    const SCALE: f64 = 1.0 / 4_294_967_296.0; // 2^-32
    let bits = rng.next_u64();
    (f64::from((bits >> 32) as u32) * SCALE, f64::from(bits as u32) * SCALE)
}

/// `f64::clamp` without its panic and NaN cases, which cost branches here.
fn limit(x: f64, min: f64, max: f64) -> f64 {
    let x = if x > max { max } else { x };
    if x < min { min } else { x }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    fn motion(settings: Settings) -> Motion<2> {
        Motion::new(Bounds::new([-1.0, 0.0], [1.0, 100.0]).unwrap(), &settings)
    }

    #[test]
    fn no_step_is_longer_than_the_velocity_limit() {
        let motion = motion(Settings { velocity_limit: 0.05, ..Settings::default() });
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let (mut child, mut longest) = (Particle::default(), [0.0_f64; 2]);
        for _ in 0..1000 {
            let parent = motion.scatter(&mut rng);
            motion.beget(&parent, &mut child, &[0.9, 90.0], 0.9, &mut rng);
            for (g, longest) in longest.iter_mut().enumerate() {
                *longest = longest.max(child.velocity[g].abs());
                // rounding of the sum aside
                assert!((child.position[g] - parent.position[g]).abs() <= motion.velocity_max[g] + 1e-12);
            }
        }
        assert_eq!(longest, [0.1, 5.0], "the limit is reached and kept");
    }

    #[test]
    fn a_particle_without_pulls_coasts_until_the_wall_stops_it() {
        let motion = motion(Settings { c1: 0.0, c2: 0.0, velocity_limit: 1.0, ..Settings::default() });
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let parent = Particle { position: [0.5, 50.0], velocity: [0.25, 80.0], ..Particle::default() };
        let mut child = Particle::default();
        motion.beget(&parent, &mut child, &[0.0; 2], 1.0, &mut rng);
        assert_eq!((child.position, child.velocity), ([0.75, 100.0], [0.25, 0.0]));
    }

    #[test]
    fn pulls_lead_to_the_own_best_and_to_the_swarms() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let parent = Particle { best_position: [0.5, 20.0], ..Particle::default() };
        let mut mean = |c1, c2| {
            let motion = motion(Settings { c1, c2, velocity_limit: 1.0, ..Settings::default() });
            let mut child = Particle::default();
            let steps = (0..10_000).map(|_| {
                motion.beget(&parent, &mut child, &[-0.25, 40.0], 0.0, &mut rng);
                child.velocity
            });
            steps.fold([0.0; 2], |sum, v| [sum[0] + v[0] / 10_000.0, sum[1] + v[1] / 10_000.0])
        };
        // Rand() has mean 1/2 and standard deviation 0.29, the mean of 10 000 thus 0.003.
        let (own, swarms) = (mean(1.0, 0.0), mean(0.0, 1.0));
        assert!((own[0] - 0.25).abs() < 0.01 && (own[1] - 10.0).abs() < 0.4, "{own:?}");
        assert!((swarms[0] + 0.125).abs() < 0.01 && (swarms[1] - 20.0).abs() < 0.8, "{swarms:?}");
    }
}
