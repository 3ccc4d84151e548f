//! A random share of a long sweep, so that each run of the tests tries other cases in a fraction of the time.
//!
//! `BRYANT_TESTS=all` tries all cases, as `.ci/nightly` does. A failed test prints its seed; `BRYANT_SEED=…` tries the
//! same share again.

use std::env;
use std::time::{SystemTime, UNIX_EPOCH};

/// One item of each `of` neighbours, chosen at random; all of them with `BRYANT_TESTS=all`.
pub fn share<T>(of: usize, items: impl IntoIterator<Item = T>) -> Vec<T> {
    if env::var("BRYANT_TESTS").is_ok_and(|which| which == "all") {
        return items.into_iter().collect();
    }
    let given = env::var("BRYANT_SEED")
        .ok()
        .map(|seed| seed.parse().expect("BRYANT_SEED is a whole number"));
    let seed = given.unwrap_or_else(|| {
        let now = SystemTime::now().duration_since(UNIX_EPOCH);
        now.map_or(0, |since| since.as_nanos() as u64)
    });
    println!("one case in {of} is tried; again with BRYANT_SEED={seed}");
    let mut random = seed;
    let mut chosen = 0;
    let mut next = move |k: usize| {
        if k.is_multiple_of(of) {
            // SplitMix64
            random = random.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (random ^ (random >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            chosen = k + ((mixed ^ (mixed >> 31)) % of as u64) as usize;
        }
        k == chosen
    };
    let items = items.into_iter().enumerate();
    items
        .filter(|(k, _)| next(*k))
        .map(|(_, item)| item)
        .collect()
}
