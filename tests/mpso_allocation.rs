//! A search works in the memory its swarm was built with.

use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;
use rps3::control::mpso::{Bounds, Selection, Settings, Swarm};

#[test]
fn searching_never_allocates() {
    // Ranked by counting and by sorting.
    for swarm_size in [20, 200] {
        for selection in [Selection::Plain, Selection::Ranked] {
            let settings = Settings { swarm_size, selection, ..Settings::default() };
            let mut swarm = Swarm::new(Bounds::new([-1.0; 3], [2.0; 3]).unwrap(), settings).unwrap();
            let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
            let bowl = |x: &[f64; 3]| x.iter().map(|x| x * x).sum();
            let first = allocation_counter::measure(|| _ = swarm.minimize(&mut rng, &[], bowl));
            let second = allocation_counter::measure(|| _ = swarm.minimize(&mut rng, &[[0.1; 3]], bowl));
            assert_eq!((first.count_total, second.count_total), (0, 0));
        }
    }
    let vector = allocation_counter::measure(|| drop(std::hint::black_box(vec![0; 8])));
    assert_eq!(vector.count_total, 1, "the counter counts");
}
