//! Collects the worst errors of accelerations over many chains and states.

use crate::balance::Tree;
use crate::bench::{Bench, Trouble};
use crate::chain::{Link, Setting, random_state, scene};
use crate::error::{backward, forward};
use crate::evaluate::Accelerations;
use crate::random::Random;

/// Largest number of elements for which the system is also solved in double-double.
const SOLVED: usize = 20;

/// Number of states of each chain.
const STATES: usize = 3;

/// The worst errors, each over n·ε.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    plain: f64,
    scaled: f64,
    forward: f64,
    chains: usize,
}

/// The larger value, or NaN if one of them is NaN.
fn worst(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

impl Survey {
    /// Measures the errors of a chain in random states.
    ///
    /// # Errors
    /// The chain is refused, or singular in double-double.
    pub fn take(
        &mut self,
        random: &mut Random,
        setting: Setting,
        links: &[Link],
    ) -> Result<(), Trouble> {
        let model = scene(setting, links)
            .model()
            .map_err(|problems| Trouble::Refused(problems.to_string()))?;
        let tree = Tree::of(&model)?;
        let mut accelerations = Accelerations::<f64>::by_elimination(&model);
        let unit = links.len() as f64 * f64::EPSILON;
        for _ in 0..STATES {
            let (q, v) = random_state(random, &model);
            let rates = accelerations.at(&q, &v);
            let found = backward(&tree, &q, &v, &rates);
            self.plain = worst(self.plain, found.plain / unit);
            self.scaled = worst(self.scaled, found.scaled / unit);
            if links.len() <= SOLVED {
                let found = forward(&tree, &q, &v, &rates)
                    .ok_or_else(|| Trouble::Failed("S is singular in double-double".to_owned()))?;
                let error = found.scaled / found.condition / unit;
                self.forward = worst(self.forward, error);
            }
        }
        self.chains += 1;
        Ok(())
    }

    /// Records the checks.
    pub fn note(self, bench: &mut Bench<'_>) {
        let states = format!("{} chains in {STATES} random states", self.chains);
        let because = |what: &str| format!("100 n ε{what}; the worst of {states}");
        bench.at_most(
            "backward error over n ε",
            self.plain,
            100.0,
            "",
            because(", required"),
        );
        bench.at_most(
            "backward error over n ε, S scaled to a diagonal of ones",
            self.scaled,
            100.0,
            "",
            because(", required for each element relative to its own size (Demmel 1989)"),
        );
        if self.forward > 0.0 || self.forward.is_nan() {
            bench.at_most(
                "forward error over κ n ε",
                self.forward,
                200.0,
                "",
                because(
                    " for each of S and r, to first order (Higham 2002, theorem 7.2), against the solution in double-double",
                ),
            );
        }
    }
}
