//! Long chains: errors of the accelerations at one state.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::chain::{ChainKind, Setting, general};
use crate::random::Random;
use crate::survey::Survey;

/// The cases of this file.
pub const CASES: &[Case] = &[Case {
    group: Group::Length,
    name: "accelerations of long chains",
    law: "S v̇ = r. The residual is that of d'Alembert's principle, body by body, in double-double at the same state. S and r, which \
          measure the error, come from the same principle, and not from the generator. An articulated-body algorithm whose matrices lose \
          their symmetry loses all digits on the way to the root.",
    run: accelerations,
}];

fn accelerations(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let counts: Vec<usize> = match bench.full() {
        false => vec![1, 2, 5, 10, 20, 50, 100],
        true => (1..=20).chain((30..=200).step_by(10)).collect(),
    };
    let seeds = if bench.full() { 3 } else { 1 };
    for kind in ChainKind::ALL {
        for loaded in [false, true] {
            let longest = counts.iter().max().copied().unwrap_or(0);
            let load = if loaded {
                "loaded at its end"
            } else {
                "without load"
            };
            let name = kind.name();
            bench.variant(format!("{name}, {load}, 1 … {longest} elements"));
            let mut survey = Survey::default();
            for seed in 0..seeds {
                for &count in &counts {
                    let mut random = Random::new(1000 * seed + count as u64);
                    let links: Vec<_> = (0..count)
                        .map(|_| {
                            let mass = random.uniform(0.5, 5.0);
                            general(&mut random, mass)
                        })
                        .collect();
                    let setting = Setting {
                        kind,
                        free: (count + seed as usize).is_multiple_of(2),
                        loaded,
                    };
                    survey.take(&mut random, setting, &links)?;
                }
            }
            survey.note(bench);
        }
    }
    Ok(())
}
