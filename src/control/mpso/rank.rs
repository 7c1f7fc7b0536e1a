//! Ranks and scores of the combined population (3.3), (3.4).
//!
//! A rank is 1 + the number of individuals that are better, so equals share a rank. Up to
//! [`COUNTING_MAX`] individuals it is found by just counting them: all pairs are compared without
//! a branch, several a cycle, which beats sorting. Larger populations are sorted.
//!
//! Keys are single precision, of which a vector register holds twice as many: individuals that differ by less than
//! 1e-7 of their distance from the best, in value or in place, are equals.

/// Keys compared at once; buffers are padded to a multiple of it.
const LANES: usize = 8;
/// Largest population for which counting is the faster way (measured).
const COUNTING_MAX: usize = 160;

/// Workspace for ranking `n` individuals by index.
#[derive(Debug, Clone)]
pub(super) struct Ranking {
    n: usize,
    /// By how much the error exceeds the best one.
    excesses: Vec<f32>,
    /// Minus the squared distance: the smaller the better, as with errors.
    nearness: Vec<f32>,
    /// F_k.
    scores: Vec<f32>,
    error_ranks: Vec<u32>,
    distance_ranks: Vec<u32>,
    score_ranks: Vec<u32>,
    /// How many individuals of a rank have been placed.
    placed: Vec<u32>,
    order: Vec<usize>,
}

impl Ranking {
    pub fn new(n: usize) -> Self {
        let padded = n.next_multiple_of(LANES);
        Self {
            n,
            // The padding is better than nobody.
            excesses: vec![f32::INFINITY; padded],
            nearness: vec![f32::INFINITY; padded],
            scores: vec![f32::INFINITY; padded],
            error_ranks: vec![1; padded],
            distance_ranks: vec![1; padded],
            score_ranks: vec![1; padded],
            placed: vec![0; n],
            order: (0..n).collect(),
        }
    }

    /// Sets by how much the error of individual `k` exceeds the best one; never NaN.
    pub fn set_excess(&mut self, k: usize, excess: f64) {
        self.excesses[k] = excess as f32;
    }

    /// Sets D_k (3.4), squared, since only its rank matters; never NaN.
    pub fn set_squared_distance(&mut self, k: usize, squared: f64) {
        self.nearness[k] = -squared as f32;
    }

    /// Scores all individuals with decay scale `s` and returns their indices by ascending score,
    /// those of equal score by index.
    pub fn by_score(&mut self, s: f64) -> &mut [usize] {
        let n = self.n;
        rank(&self.excesses, n, &mut self.error_ranks, &mut self.order);
        rank(&self.nearness, n, &mut self.distance_ranks, &mut self.order);
        for (k, score) in self.scores[..n].iter_mut().enumerate() {
            *score = (f64::from(self.error_ranks[k]) + s * f64::from(self.distance_ranks[k])) as f32; // (3.3)
        }
        rank(&self.scores, n, &mut self.score_ranks, &mut self.order);
        self.placed.fill(0);
        for k in 0..n {
            let first = self.score_ranks[k] as usize - 1;
            self.order[first + self.placed[first] as usize] = k;
            self.placed[first] += 1;
        }
        &mut self.order
    }
}

/// Ranks the first `n` of `keys`, smallest first; `order` is scratch space.
fn rank(keys: &[f32], n: usize, ranks: &mut [u32], order: &mut [usize]) {
    if n <= COUNTING_MAX {
        rank_by_counting(keys, ranks);
    } else {
        rank_by_sorting(&keys[..n], ranks, order);
    }
}

fn rank_by_counting(keys: &[f32], ranks: &mut [u32]) {
    let (blocks, _) = keys.as_chunks::<LANES>();
    let (rank_blocks, _) = ranks.as_chunks_mut::<LANES>();
    for (block, rank_block) in blocks.iter().zip(rank_blocks) {
        let mut ranks = [1; LANES];
        for &other in keys {
            for (rank, &key) in ranks.iter_mut().zip(block) {
                *rank += u32::from(other < key);
            }
        }
        *rank_block = ranks;
    }
}

fn rank_by_sorting(keys: &[f32], ranks: &mut [u32], order: &mut [usize]) {
    for (k, index) in order.iter_mut().enumerate() {
        *index = k;
    }
    order.sort_unstable_by(|&a, &b| keys[a].total_cmp(&keys[b]));
    let (mut rank, mut previous) = (1, keys[order[0]]);
    for (place, &index) in (1..).zip(order.iter()) {
        if previous < keys[index] {
            (rank, previous) = (place, keys[index]);
        }
        ranks[index] = rank;
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    /// 1 + the number of individuals that are better.
    fn by_definition(keys: &[f32]) -> Vec<u32> {
        keys.iter().map(|key| 1 + keys.iter().filter(|other| *other < key).count() as u32).collect()
    }

    #[test]
    fn both_ways_of_ranking_follow_the_definition() {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
        for n in [2_usize, 7, 8, 40, 41, 200] {
            // Few distinct values: many equals, among them infinity.
            let mut keys: Vec<f32> = (0..n).map(|_| 1.0 / (rng.next_u64() % 16) as f32).collect();
            let expected = by_definition(&keys);
            let (mut ranks, mut order) = (vec![0; n.next_multiple_of(LANES)], vec![0; n]);
            rank_by_sorting(&keys, &mut ranks, &mut order);
            assert_eq!(ranks[..n], expected);
            keys.resize(n.next_multiple_of(LANES), f32::INFINITY);
            rank_by_counting(&keys, &mut ranks);
            assert_eq!(ranks[..n], expected);
        }
    }

    #[test]
    fn score_adds_the_error_rank_and_the_scaled_distance_rank() {
        // Errors rank 1, 2, 3, 4; the third is farthest from the best, then the fourth, the second.
        let mut ranking = Ranking::new(4);
        for (k, (error, squared_distance)) in
            [(0.1, 0.0), (0.2, 0.5), (0.3, 9.0), (f64::INFINITY, 4.0)].into_iter().enumerate()
        {
            ranking.set_excess(k, error - 0.1);
            ranking.set_squared_distance(k, squared_distance);
        }
        // s = 0.7: F = 1 + 2.8, 2 + 2.1, 3 + 0.7, 4 + 1.4 = 3.8, 4.1, 3.7, 5.4
        assert_eq!(ranking.by_score(0.7), [2, 0, 1, 3]);
        // s = 0.005: error decides.
        assert_eq!(ranking.by_score(0.005), [0, 1, 2, 3]);
        // s = 1: F = 5, 5, 4, 6; equals stay in order.
        assert_eq!(ranking.by_score(1.0), [2, 0, 1, 3]);
    }
}
