//! The swarm's search for the damping of a tick: scales of the particle's members and initial individuals.

use rand::Rng;
use rand::distr::{Distribution, StandardUniform};
use serde::{Deserialize, Serialize};

use super::damping::SMALLEST_SIGMA;
use super::mpso::{Bounds, Progress, SettingsError, Solution, Swarm};
use super::parameters::SwarmParameters;
use super::{Damping, Fitness};

/// A swarm over (rho, delta_hd) for six motors; three have a force distribution to damp as well.
#[derive(Debug, Clone)]
pub(super) struct Search {
    swarm: Members,
    parameters: SwarmParameters,
}

#[derive(Debug, Clone)]
enum Members {
    Two(Swarm<2>),
    Three(Swarm<3>),
}

/// Where the searches so far ended: the best particle of each quarter of (rho, delta_hd) at the last tick that
/// looked there, the best first. The fitness can have a valley in each, and which one is lowest changes from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Elite {
    /// Members within [0, 1]; the third is not used with six motors.
    particles: [[f64; 3]; QUARTERS],
}

const QUARTERS: usize = 4;
/// Initial individuals around the last optimum, each within half the distance of the one before, from
/// [`FARTHEST`] on: the optimum moves little from tick to tick as a rule, and sometimes it leaps.
const NEIGHBOURS: usize = 6;
const FARTHEST: f64 = 0.2;
/// Whose neighbours others are, by place in the elite: the valley that is lowest next wants to be followed too.
const OTHERS: [usize; 5] = [1, 1, 2, 2, 3];
/// Their distances lie between these, every decade as likely.
const OTHERS_DISTANCES: (f64, f64) = (7e-4, 0.3);
/// Initial individuals without damped velocity, with any rho, and with a lambda_f that close to that of the best or of
/// any of the elite: their valleys are long in rho, narrow in lambda_f.
const UNHELD: usize = 4;
const UNHELD_DISTANCE: f64 = 0.05;
/// Initial individuals that are not scattered over all dampings, at most.
const STARTS: usize = QUARTERS + NEIGHBOURS + OTHERS.len() + UNHELD;

impl Search {
    /// # Errors
    /// The first setting that is out of its range.
    pub fn new(parameters: SwarmParameters, revolute_motors: bool) -> Result<Self, SettingsError> {
        let settings = parameters.settings;
        let swarm = if revolute_motors {
            Members::Two(Swarm::new(Bounds::new([0.0; 2], [1.0; 2])?, settings)?)
        } else {
            Members::Three(Swarm::new(Bounds::new([0.0; 3], [1.0; 3])?, settings)?)
        };
        Ok(Self { swarm, parameters })
    }

    /// The damping of least `fitness` at `sigma_min`, starting from the `elite` of the search before; tells `observer`
    /// how the search goes on.
    pub fn find(
        &mut self,
        rng: &mut impl Rng,
        elite: &mut Elite,
        fitness: &Fitness,
        sigma_min: f64,
        observer: impl FnMut(&Progress),
    ) -> (Damping<f64>, Solution<3>) {
        let Self { swarm, parameters: SwarmParameters { settings, largest } } = self;
        // the rest, one at least, is scattered over all dampings
        let known = STARTS.min(settings.swarm_size - 1);
        let starts = elite.starts(rng);
        let mut found = [(f64::INFINITY, [0.0; 3]); QUARTERS];
        for particle in elite.particles {
            found[quarter(&particle)].1 = particle;
        }
        let largest_rho_hd = fitness.rho_hd(largest);
        let mut value = |z: &[f64; 3]| {
            let Shares { rho, rho_hd, lambda_f } = Shares::of(z);
            let value = fitness.of_factors(largest.rho * rho, largest_rho_hd * rho_hd, largest.lambda_f * lambda_f);
            let found = &mut found[quarter(z)];
            if value < found.0 {
                *found = (value, *z);
            }
            value
        };
        let solution = match swarm {
            Members::Two(swarm) => {
                let starts = starts.map(|[x, y, _]| [x, y]);
                let Solution { position: [x, y], value, iterations, evaluations } =
                    swarm.minimize_observed(rng, &starts[..known], |[x, y]| value(&[*x, *y, 0.0]), observer);
                Solution { position: [x, y, 0.0], value, iterations, evaluations }
            }
            Members::Three(swarm) => swarm.minimize_observed(rng, &starts[..known], value, observer),
        };
        found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        elite.particles = found.map(|(_, particle)| particle);
        (damping(&solution.position, largest, sigma_min), solution)
    }
}

impl Elite {
    /// Initial individuals, those that matter most first.
    fn starts(&self, rng: &mut impl Rng) -> [[f64; 3]; STARTS] {
        let [best, ..] = self.particles;
        let mut starts = [best; STARTS];
        let (elite, rest) = starts.split_at_mut(QUARTERS);
        let (neighbours, rest) = rest.split_at_mut(NEIGHBOURS);
        let (others, unheld) = rest.split_at_mut(OTHERS.len());
        elite.copy_from_slice(&self.particles);
        let mut distance = FARTHEST;
        for start in neighbours {
            *start = start.map(|x| x + within(distance, rng));
            distance *= 0.5;
        }
        let (nearest, farthest) = OTHERS_DISTANCES;
        for (start, place) in others.iter_mut().zip(OTHERS) {
            let distance = farthest * libm::pow(nearest / farthest, uniform(rng));
            *start = self.particles[place].map(|x| x + within(distance, rng));
        }
        for (k, start) in unheld.iter_mut().enumerate() {
            let near = if k % 2 == 0 { 0 } else { (uniform(rng) * QUARTERS as f64) as usize };
            let lambda_f = self.particles[near][2] + within(UNHELD_DISTANCE, rng);
            *start = [uniform(rng), 0.0, lambda_f];
        }
        starts
    }
}

fn uniform(rng: &mut impl Rng) -> f64 {
    StandardUniform.sample(rng)
}

/// Uniform within +-`distance`.
fn within(distance: f64, rng: &mut impl Rng) -> f64 {
    distance * (2.0 * uniform(rng) - 1.0)
}

/// The quarter of (rho, delta_hd) in which a particle lies.
fn quarter(z: &[f64; 3]) -> usize {
    usize::from(z[0] > 0.5) + 2 * usize::from(z[1] > 0.5)
}

impl Default for Elite {
    /// Before the first search: the middle of each quarter.
    fn default() -> Self {
        Self { particles: [[0.25, 0.25, 0.5], [0.75, 0.25, 0.5], [0.25, 0.75, 0.5], [0.75, 0.75, 0.5]] }
    }
}

/// What a particle with members in [0, 1] takes of the largest factors.
///
/// rho and lambda_f act over decades, three and six of them: as powers of a member they have room where they
/// are small, and zero is within reach. delta_hd acts only by rho_hd, and not at all below sigma_min.
struct Shares {
    rho: f64,
    rho_hd: f64,
    lambda_f: f64,
}

impl Shares {
    fn of(z: &[f64; 3]) -> Self {
        let square = z.map(|z| z * z);
        Self { rho: square[0] * z[0], rho_hd: square[1] * square[1], lambda_f: square[2] * square[2] * square[2] }
    }
}

/// The damping of a particle. Where no delta_hd takes effect it is the share of the largest.
fn damping(z: &[f64; 3], largest: &Damping<f64>, sigma_min: f64) -> Damping<f64> {
    let Shares { rho, rho_hd, lambda_f } = Shares::of(z);
    let sigma = sigma_min.max(SMALLEST_SIGMA);
    let delta_hd = if sigma < largest.delta_hd {
        // (4.16) for delta_hd
        (sigma / (1.0 - rho_hd * (1.0 - sigma / largest.delta_hd))).min(largest.delta_hd)
    } else {
        largest.delta_hd * rho_hd
    };
    Damping { rho: largest.rho * rho, delta_hd, lambda_f: largest.lambda_f * lambda_f }
}
