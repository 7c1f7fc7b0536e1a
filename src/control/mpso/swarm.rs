//! The search itself.

use rand::Rng;

use super::particle::{Motion, Particle};
use super::rank::Ranking;
use super::{Bounds, DecaySchedule, Selection, Settings, SettingsError, inertia};

/// A modified particle swarm over a box in `D` dimensions: settings and workspace. It keeps
/// nothing from one search for the next; pass the last optimum as a start for that.
#[derive(Debug, Clone)]
pub struct Swarm<const D: usize> {
    settings: Settings,
    motion: Motion<D>,
    /// 1 / width of the members' ranges, which makes distances commensurate; 0 for fixed members.
    scale: [f64; D],
    /// The combined population, parents and offspring in no particular place.
    particles: Vec<Particle<D>>,
    /// Indices into `particles`: first the PS individuals of the present generation, then the
    /// places where their offspring go.
    order: Vec<usize>,
    ranking: Ranking,
}

/// The best point a search has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution<const D: usize> {
    /// Where it is, within the bounds.
    pub position: [f64; D],
    /// The objective there; infinite if it was finite nowhere.
    pub value: f64,
    /// Iterations made.
    pub iterations: usize,
    /// Evaluations of the objective: PS of the initial swarm and PS an iteration.
    pub evaluations: usize,
}

/// How a search stands at the end of an iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Iterations made; 0 stands for the initial swarm.
    pub iteration: usize,
    /// Smallest objective so far.
    pub best_value: f64,
    /// Decay scale s (3.5) for the next iteration.
    pub decay_scale: f64,
}

impl<const D: usize> Swarm<D> {
    /// A swarm for `bounds`, with all the memory its searches need.
    ///
    /// # Errors
    /// The first setting that is out of its range.
    pub fn new(bounds: Bounds<D>, settings: Settings) -> Result<Self, SettingsError> {
        settings.check()?;
        let population = 2 * settings.swarm_size;
        Ok(Self {
            settings,
            motion: Motion::new(bounds, &settings),
            scale: bounds.width().map(|w| if w > 0.0 { 1.0 / w } else { 0.0 }),
            particles: vec![Particle::default(); population],
            order: (0..population).collect(),
            ranking: Ranking::new(population),
        })
    }

    /// Searches the minimum of `objective`.
    ///
    /// The initial swarm begins with `starts`, clamped to the bounds, as far as there is room; those
    /// with a member that is not finite are left out. The others are scattered over the box. Values of
    /// the objective that are not finite count as worst, and so do, in the ranking, those that exceed the best by more than
    /// single precision holds (3e38).
    pub fn minimize(
        &mut self,
        rng: &mut impl Rng,
        starts: &[[f64; D]],
        objective: impl FnMut(&[f64; D]) -> f64,
    ) -> Solution<D> {
        self.minimize_observed(rng, starts, objective, |_| {})
    }

    /// [`minimize`](Self::minimize) that tells `observer` about the initial swarm and every iteration.
    pub fn minimize_observed(
        &mut self,
        rng: &mut impl Rng,
        starts: &[[f64; D]],
        mut objective: impl FnMut(&[f64; D]) -> f64,
        mut observer: impl FnMut(&Progress),
    ) -> Solution<D> {
        let size = self.settings.swarm_size;
        let mut decay = DecaySchedule::new(&self.settings);
        let mut best = self.populate(rng, starts, &mut objective);
        let mut iterations = 0;
        let mut stalled = 0;
        observer(&Progress { iteration: 0, best_value: best.error, decay_scale: decay.scale() });

        while iterations < self.settings.max_iterations && stalled < self.settings.stall_iterations {
            let improved = self.procreate(rng, inertia(&self.settings, iterations), &mut best, &mut objective);
            match self.settings.selection {
                Selection::Plain => self.order.rotate_left(size),
                Selection::Ranked => self.select(&best, decay.scale()),
            }
            decay.advance(improved);
            stalled = if improved { 0 } else { stalled + 1 };
            iterations += 1;
            observer(&Progress { iteration: iterations, best_value: best.error, decay_scale: decay.scale() });
        }
        Solution { position: best.position, value: best.error, iterations, evaluations: size * (1 + iterations) }
    }

    /// Scatters the initial swarm and returns its best individual.
    fn populate(
        &mut self,
        rng: &mut impl Rng,
        starts: &[[f64; D]],
        objective: &mut impl FnMut(&[f64; D]) -> f64,
    ) -> Best<D> {
        // The order a former search left behind must not matter.
        for (k, index) in self.order.iter_mut().enumerate() {
            *index = k;
        }
        let size = self.settings.swarm_size;
        for particle in &mut self.particles[..size] {
            *particle = self.motion.scatter(rng);
        }
        let finite = starts.iter().filter(|start| start.iter().all(|x| x.is_finite()));
        for (particle, start) in self.particles[..size].iter_mut().zip(finite) {
            particle.place(self.motion.bounds.clamp(start));
        }
        let mut best = Best { index: 0, position: self.particles[0].position, error: f64::INFINITY };
        for index in 0..size {
            let error = self.evaluate(index, objective);
            best.update(index, &self.particles[index], error);
        }
        best
    }

    /// Moves every individual of the generation into an offspring of its own; tells whether one of
    /// them is a new best.
    fn procreate(
        &mut self,
        rng: &mut impl Rng,
        w: f64,
        best: &mut Best<D>,
        objective: &mut impl FnMut(&[f64; D]) -> f64,
    ) -> bool {
        // All of a generation are drawn to the best of the one before (3.1).
        let attractor = best.position;
        let mut improved = false;
        for j in 0..self.settings.swarm_size {
            let index = self.order[self.settings.swarm_size + j];
            let [parent, child] =
                self.particles.get_disjoint_mut([self.order[j], index]).expect("the order holds every index once");
            self.motion.beget(parent, child, &attractor, w, rng);
            let error = self.evaluate(index, objective);
            improved |= best.update(index, &self.particles[index], error);
        }
        improved
    }

    /// Evaluates an individual, which takes note of its error.
    fn evaluate(&mut self, index: usize, objective: &mut impl FnMut(&[f64; D]) -> f64) -> f64 {
        let particle = &mut self.particles[index];
        let value = objective(&particle.position);
        let error = if value.is_finite() { value } else { f64::INFINITY };
        particle.remember(error);
        error
    }

    /// Lets the PS individuals with the smallest scores (3.3) survive, and the best in any case.
    fn select(&mut self, best: &Best<D>, s: f64) {
        for (k, particle) in self.particles.iter().enumerate() {
            // All are equal as long as the best is infinite too, for NaN.max(0) is 0.
            self.ranking.set_excess(k, (particle.error - best.error).max(0.0));
            self.ranking.set_squared_distance(k, squared_distance(&particle.position, &best.position, &self.scale));
        }
        self.order.copy_from_slice(self.ranking.by_score(s));
        let size = self.settings.swarm_size;
        if let Some(place) = self.order[size..].iter().position(|&k| k == best.index) {
            self.order.swap(size - 1, size + place);
        }
    }
}

/// D_k (3.4), squared, each member's difference times its `scale`.
#[inline]
fn squared_distance<const D: usize>(a: &[f64; D], b: &[f64; D], scale: &[f64; D]) -> f64 {
    let mut squared = 0.0;
    for g in 0..D {
        let difference = scale[g] * (a[g] - b[g]);
        squared += difference * difference;
    }
    squared
}

/// The best individual so far.
struct Best<const D: usize> {
    /// Its index in the combined population; the ranked selection keeps it there.
    index: usize,
    position: [f64; D],
    error: f64,
}

impl<const D: usize> Best<D> {
    /// Takes over `particle` if its error is smaller; tells whether it was.
    fn update(&mut self, index: usize, particle: &Particle<D>, error: f64) -> bool {
        let improved = error < self.error;
        if improved {
            *self = Self { index, position: particle.position, error };
        }
        improved
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    #[test]
    fn distance_counts_each_member_in_its_range() {
        let bounds = Bounds::new([0.0, -50.0, 7.0], [1.0, 50.0, 7.0]).unwrap();
        let swarm = Swarm::new(bounds, Settings::default()).unwrap();
        // 0.3 and 0.4 of the ranges, and a member without a range
        let squared = squared_distance(&[0.5, 20.0, 7.0], &[0.2, -20.0, 7.0], &swarm.scale);
        assert!((squared - 0.25).abs() < 1e-15, "{squared}");
    }

    #[test]
    fn the_best_survives_even_where_its_score_is_poor() {
        // Distance counts far more than error: the best, at distance 0, has the largest score.
        let settings = Settings { decay_max: 1e3, decay_min: 1e3, ..Settings::default() };
        let mut swarm = Swarm::new(Bounds::new([-1.0; 2], [1.0; 2]).unwrap(), settings).unwrap();
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut bowl = |x: &[f64; 2]| x[0] * x[0] + x[1] * x[1];
        let mut best = swarm.populate(&mut rng, &[], &mut bowl);
        for _ in 0..20 {
            swarm.procreate(&mut rng, 0.7, &mut best, &mut bowl);
            swarm.select(&best, 1e3);
            // It takes the place of the last of the survivors.
            assert_eq!(swarm.order[settings.swarm_size - 1], best.index);
            assert_eq!(swarm.particles[best.index].position, best.position);
            let mut indices = swarm.order.clone();
            indices.sort_unstable();
            assert!(indices.into_iter().eq(0..2 * settings.swarm_size), "every individual has one place");
        }
    }
}
