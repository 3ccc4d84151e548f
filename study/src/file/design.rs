//! Reads `design`, `runs`, `seed` and `parameters`, which define the rows of a study.

use super::distribution;
use super::keys::Design;
use super::reader::{self, Reader, entries, optional, word};
use super::rows;
use crate::design::most_parameters;
use crate::facts::{ModelFacts, ParameterFact};
use crate::study::{Levels, MOST_ROWS, Plan, RandomDesign, Varied};
use bryant_generator::description::place::At;
use std::path::Path;

/// The rows that the file describes.
pub struct Planned {
    pub rows: u64,
    pub varied: Vec<Varied>,
    pub plan: Plan,
}

/// Reads the design; `None` if there is a problem, which the reader collects.
pub fn read(
    reader: &Reader,
    root: At<'_>,
    facts: &ModelFacts,
    directory: &Path,
) -> Option<Planned> {
    let design: Design = word(optional(root, "design")?)?;
    let unused: &[(&str, &str)] = match design {
        Design::Grid => &[
            (
                "runs",
                "a grid has as many runs as its steps and values make",
            ),
            ("seed", "nothing in a grid is random"),
            ("rows", "rows are those of `design: list`"),
        ],
        Design::List => &[
            ("runs", "a list has as many runs as rows"),
            ("seed", "nothing in a list is random"),
            (
                "parameters",
                "the rows of a list name the parameters; one value for all runs stands under `fixed`",
            ),
        ],
        _ => &[("rows", "rows are those of `design: list`")],
    };
    for (key, help) in unused {
        if let Some(at) = optional(root, key) {
            let message = format!("`{key}` has no meaning with `design: {}`", design.word());
            reader.add(at.key_problem(message, format!("remove it: {help}")));
        }
    }
    match design {
        Design::Grid => grid(reader, root, facts),
        Design::List => rows::read(reader, root, facts, directory),
        Design::LatinHypercube => random(reader, root, facts, RandomDesign::LatinHypercube),
        Design::Sobol => random(reader, root, facts, RandomDesign::Sobol),
        Design::MonteCarlo => random(reader, root, facts, RandomDesign::MonteCarlo),
        Design::Saltelli => random(reader, root, facts, RandomDesign::Saltelli),
    }
}

/// The parameter with this name; if there is none, adds a problem that suggests the nearest name.
pub fn known<'f>(
    reader: &Reader,
    at: At<'_>,
    name: &str,
    facts: &'f ModelFacts,
) -> Option<&'f ParameterFact> {
    let found = facts.parameter(name);
    if found.is_none() {
        let (message, help) = facts.no_parameter(name);
        reader.add(at.key_problem(message, help));
    }
    found
}

/// The entries of `parameters` that the model knows, with the places of their values.
fn parameters<'a, 'f>(
    reader: &Reader,
    root: At<'a>,
    facts: &'f ModelFacts,
) -> Option<Vec<(At<'a>, &'f ParameterFact)>> {
    let at = reader.required(
        root,
        "parameters",
        "name the parameters that differ between runs, with their ranges",
    )?;
    let entries = entries(at);
    if entries.is_empty() {
        reader.add(at.problem(
            "no parameter is varied",
            "name at least one, such as `slack: { from: 0 mm, to: 60 mm }`",
        ));
    }
    let found = entries
        .iter()
        .map(|(name, at)| Some((*at, known(reader, *at, name, facts)?)))
        .collect::<Vec<_>>();
    found.into_iter().collect()
}

fn varied(of: &[(At<'_>, &ParameterFact)]) -> Vec<Varied> {
    of.iter()
        .map(|(at, fact)| reader::varied(fact, [at.node]))
        .collect()
}

fn grid(reader: &Reader, root: At<'_>, facts: &ModelFacts) -> Option<Planned> {
    let found = parameters(reader, root, facts)?;
    let all: Vec<Option<Levels>> = found
        .iter()
        .map(|(at, fact)| distribution::levels(reader, *at, fact))
        .collect();
    let all: Vec<_> = all.into_iter().collect::<Option<_>>()?;
    let rows = all.iter().fold(1u128, |n, levels| {
        n.saturating_mul(u128::from(levels.count()))
    });
    let counts = || {
        let one = |(levels, (_, fact)): (&Levels, &(At<'_>, &ParameterFact))| {
            format!("{} of {}", levels.count(), fact.name)
        };
        all.iter()
            .zip(&found)
            .map(one)
            .collect::<Vec<_>>()
            .join(" × ")
    };
    let rows = within(reader, root, "parameters", rows, || {
        format!(
            "the grid is {}: take fewer steps, or `design: sobol` with `runs`",
            counts()
        )
    })?;
    Some(Planned {
        rows,
        varied: varied(&found),
        plan: Plan::Grid(all),
    })
}

fn random(
    reader: &Reader,
    root: At<'_>,
    facts: &ModelFacts,
    design: RandomDesign,
) -> Option<Planned> {
    let runs = reader
        .required(root, "runs", "say how many, such as `runs: 1024`")
        .and_then(|at| reader.count(at, "the number of runs"));
    let seed = match optional(root, "seed") {
        Some(at) => reader.whole(at, "the seed"),
        None => Some(0),
    };
    let found = parameters(reader, root, facts)?;
    let distributions: Vec<_> = found
        .iter()
        .map(|(at, fact)| distribution::read(reader, *at, fact))
        .collect();
    let distributions: Vec<_> = distributions.into_iter().collect::<Option<_>>()?;
    let (runs, seed) = (runs?, seed?);
    let d = found.len();
    let place = root.key("parameters");
    if d > most_parameters(design) {
        let message = format!("{d} parameters are varied");
        let help = format!(
            "this design can vary {}: take `latin hypercube` or `monte carlo`",
            most_parameters(design)
        );
        reader.add(place.key_problem(message, help));
        return None;
    }
    let rows = if design == RandomDesign::Saltelli {
        let group = d as u64 + 2;
        if runs < group {
            let message = format!("{runs} runs are less than one group of the design");
            let help =
                format!("a group is {group} runs, parameters + 2; indices need hundreds of groups");
            reader.add(root.key("runs").problem(message, help));
            return None;
        }
        runs - runs % group
    } else {
        runs
    };
    let rows = within(reader, root, "runs", u128::from(rows), || {
        "take fewer runs".into()
    })?;
    Some(Planned {
        rows,
        varied: varied(&found),
        plan: Plan::Random {
            design,
            seed,
            distributions,
        },
    })
}

/// The number of rows, if it is not too large.
pub fn within(
    reader: &Reader,
    root: At<'_>,
    key: &str,
    rows: u128,
    help: impl Fn() -> String,
) -> Option<u64> {
    if rows <= u128::from(MOST_ROWS) {
        return u64::try_from(rows).ok();
    }
    let count = if rows == u128::MAX {
        "more than 1e38".into()
    } else {
        format!("{:e}", rows as f64)
    };
    let message = format!(
        "the study has {count} runs; at most {:e} are possible",
        MOST_ROWS as f64
    );
    reader.add(root.key(key).key_problem(message, help()));
    None
}
