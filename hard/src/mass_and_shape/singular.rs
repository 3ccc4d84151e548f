//! Models must be refused when they are read if and only if S is singular in every position.

use crate::balance::Tree;
use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::chain::{ChainKind, Link, Setting, random_state, scene};
use crate::error::smallest_pivot;
use crate::random::Random;
use bryant_generator::model::{Dimension, Model};

/// Singular models, written by hand.
pub const REFUSED: Case = Case {
    group: Group::MassAndShape,
    name: "singular models are refused",
    law: "An element that can move without kinetic energy has no definite acceleration. Such a model is refused when it is read; the \
          message names the element that moves and the axis that it turns about. A model that differs slightly and is not singular is \
          accepted.",
    run: refused,
};

/// Singular models, made at random.
pub const RANDOM: Case = Case {
    group: Group::MassAndShape,
    name: "refused if and only if singular",
    law: "The chains consist of points, needles, plates and bodies, with joints and centres of gravity that coincide or lie in line. A \
          chain is refused if and only if L D Lᵀ of S in double-double, at random positions, has a pivot that is 0 within rounding.",
    run: random,
};

/// A model written by hand: its parts, and the expected message.
struct Way {
    name: &'static str,
    dimension: u8,
    reference: &'static str,
    elements: &'static [&'static str],
    /// Words that the message must have: the element, the axis. Empty if the model must be accepted.
    said: &'static [&'static str],
}

const WAYS: &[Way] = &[
    Way {
        name: "a leaf with its mass in its joint, in the plane",
        dimension: 2,
        reference: "fixed",
        elements: &[
            "{ name: arm, mass: 1, cg: [0.1, 0], inertia: 0.1 }",
            "{ name: tip, on: arm, at: [0.3, 0], mass: 1, cg: [0, 0], inertia: 0 }",
        ],
        said: &["element \"tip\" can turn about its joint"],
    },
    Way {
        name: "the same with a centre of gravity a micrometre off",
        dimension: 2,
        reference: "fixed",
        elements: &[
            "{ name: arm, mass: 1, cg: [0.1, 0], inertia: 0.1 }",
            "{ name: tip, on: arm, at: [0.3, 0], mass: 1, cg: [1 um, 0], inertia: 0 }",
        ],
        said: &[],
    },
    Way {
        name: "a point on a free joint, in the plane",
        dimension: 2,
        reference: "free",
        elements: &["{ name: ball, mass: 1, cg: [0.1, 0.2], inertia: 0 }"],
        said: &["its root \"ball\" turns about its centre of gravity"],
    },
    Way {
        name: "the same on a fixed joint: a pendulum",
        dimension: 2,
        reference: "fixed",
        elements: &["{ name: ball, mass: 1, cg: [0.1, 0.2], inertia: 0 }"],
        said: &[],
    },
    Way {
        name: "a point that carries a point at its own place",
        dimension: 2,
        reference: "free",
        elements: &[
            "{ name: ball, mass: 1, cg: [0.1, 0.2], inertia: 0 }",
            "{ name: rider, on: ball, at: [0.1, 0.2], mass: 1, cg: [0.3, 0], inertia: 0.1 }",
        ],
        said: &["its root \"ball\" turns about its centre of gravity"],
    },
    Way {
        name: "two points on two arms, which hold each other but in line",
        dimension: 2,
        reference: "free",
        elements: &[
            "{ name: ball, mass: 1, cg: [0.1, 0.2], inertia: 0 }",
            "{ name: rider, on: ball, at: [0.4, 0], mass: 1, cg: [0.3, 0], inertia: 0 }",
        ],
        said: &[],
    },
    Way {
        name: "a point in space",
        dimension: 3,
        reference: "fixed",
        elements: &["{ name: bob, mass: 1, cg: [0, 0.3, 0], inertia: [0, 0, 0] }"],
        said: &[
            "element \"bob\" can turn about the axis [0, 1, 0]",
            "through its joint",
        ],
    },
    Way {
        name: "a needle on a ball joint in its line",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: torso, mass: 1, cg: [0.1, 0, 0], inertia: [1, 1, 1] }",
            "{ name: needle, on: torso, at: [0, 1, 0], mass: 1, cg: [0, 0, -0.3], inertia: [0.1, 0.1, 0] }",
        ],
        said: &[
            "element \"needle\" can turn about the axis [0, 0, 1]",
            "through its joint",
        ],
    },
    Way {
        name: "a needle turned in its frame, in line with its centre of gravity",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: needle, mass: 1, cg: [0.3, 0, 0.3], inertia: [0.1, 0.1, 0], axes: [0, 45 deg, 0] }",
        ],
        said: &["element \"needle\" can turn about the axis [1, 0, 1]"],
    },
    Way {
        name: "a needle beside its joint",
        dimension: 3,
        reference: "fixed",
        elements: &["{ name: needle, mass: 1, cg: [0.01, 0, -0.3], inertia: [0.1, 0.1, 0] }"],
        said: &[],
    },
    Way {
        name: "a needle on a free joint beside it",
        dimension: 3,
        reference: "free",
        elements: &["{ name: needle, mass: 1, cg: [0.01, 0, -0.3], inertia: [0.1, 0.1, 0] }"],
        said: &[
            "its root \"needle\" turns about the axis [0, 0, 1]",
            "through its centre of gravity",
        ],
    },
    Way {
        name: "a needle that carries a body in its line",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: needle, mass: 1, cg: [0, 0, -0.3], inertia: [0.1, 0.1, 0] }",
            "{ name: hand, on: needle, at: [0, 0, -0.7], mass: 5, cg: [0.1, 0, 0], inertia: [1, 1, 1] }",
        ],
        said: &["element \"needle\" can turn about the axis [0, 0, 1]"],
    },
    Way {
        name: "a needle that carries a body beside its line",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: needle, mass: 1, cg: [0, 0, -0.3], inertia: [0.1, 0.1, 0] }",
            "{ name: hand, on: needle, at: [0.2, 0, -0.7], mass: 5, cg: [0.1, 0, 0], inertia: [1, 1, 1] }",
        ],
        said: &[],
    },
    Way {
        name: "a needle that carries a point that yields: the point turns alone",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: needle, mass: 1, cg: [0, 0, -0.3], inertia: [0.1, 0.1, 0] }",
            "{ name: bob, on: needle, at: [0.2, 0, -0.7], mass: 5, cg: [0.3, 0, 0], inertia: [0, 0, 0] }",
        ],
        said: &["element \"bob\" can turn about the axis [1, 0, 0]"],
    },
    Way {
        name: "a point in its joint that carries a body there",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: knot, mass: 1, cg: [0, 0, 0], inertia: [0, 0, 0] }",
            "{ name: body, on: knot, at: [0, 0, 0], mass: 1, cg: [0, 0, -0.3], inertia: [1, 1, 1] }",
        ],
        said: &["element \"knot\" can turn about the axis"],
    },
    Way {
        name: "a massless arm, its mass in its joint, that carries bodies at two ends",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: arm, mass: 1, cg: [0, 0, 0], inertia: [0, 0, 0] }",
            "{ name: left, on: arm, at: [0.5, 0, 0], mass: 1, cg: [0, 0, -0.3], inertia: [1, 1, 1] }",
            "{ name: right, on: arm, at: [0, 0.5, 0], mass: 1, cg: [0, 0, -0.3], inertia: [1, 1, 1] }",
        ],
        said: &[],
    },
    Way {
        name: "the same with the ends in one line",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: arm, mass: 1, cg: [0, 0, 0], inertia: [0, 0, 0] }",
            "{ name: left, on: arm, at: [0.5, 0, 0], mass: 1, cg: [0, 0, -0.3], inertia: [1, 1, 1] }",
            "{ name: right, on: arm, at: [-0.2, 0, 0], mass: 1, cg: [0, 0, -0.3], inertia: [1, 1, 1] }",
        ],
        said: &["element \"arm\" can turn about the axis [1, 0, 0]"],
    },
    Way {
        name: "no mass",
        dimension: 2,
        reference: "fixed",
        elements: &["{ name: ghost, mass: 0, cg: [0.1, 0], inertia: 0.1 }"],
        said: &["`mass` of tree/ghost must be positive"],
    },
    Way {
        name: "light beside what it carries, but a body: 1e-8 kg that carries 1e6 kg",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: wire, mass: 1e-8, cg: [0.01, 0, -0.1], inertia: [1e-10, 1e-10, 1e-10] }",
            "{ name: block, on: wire, at: [0, 0.1, -0.2], mass: 1e6, cg: [0, 0, -0.3], inertia: [1e5, 1e5, 1e5] }",
        ],
        said: &["element \"wire\"", "so little that rounding hides it"],
    },
    Way {
        name: "1e-3 kg that carries 1e6 kg",
        dimension: 3,
        reference: "fixed",
        elements: &[
            "{ name: wire, mass: 1e-3, cg: [0.01, 0, -0.1], inertia: [1e-5, 1e-5, 1e-5] }",
            "{ name: block, on: wire, at: [0, 0.1, -0.2], mass: 1e6, cg: [0, 0, -0.3], inertia: [1e5, 1e5, 1e5] }",
        ],
        said: &[],
    },
];

fn refused(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    for way in WAYS {
        bench.variant(way.name);
        let mut text = format!(
            "model: singular\ndimension: {}\nsystems:\n  - name: tree\n    reference: {}\n    elements:\n",
            way.dimension, way.reference
        );
        for element in way.elements {
            text.push_str(&format!("      - {element}\n"));
        }
        let model = CaseModel::new("singular", text).model();
        if way.said.is_empty() {
            let seen = match &model {
                Ok(_) => "accepted".to_owned(),
                Err(problems) => first_line(&problems.to_string()),
            };
            let because = "every motion has kinetic energy";
            bench.states("accepted", model.is_ok(), seen, because);
        } else {
            let (refused, seen) = match &model {
                Ok(_) => (false, "accepted".to_owned()),
                Err(problems) => {
                    let text = problems.to_string();
                    let said = way.said.iter().all(|words| text.contains(words));
                    (said, first_line(&text))
                }
            };
            let because = "a motion has no kinetic energy, or less than the rounding";
            let criterion = format!("refused, saying “{}”", way.said.join(" … "));
            bench.states(criterion, refused, seen, because);
        }
    }
    Ok(())
}

fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

/// A random link from few possible values, so that coincidences that make S singular are frequent.
fn odd(random: &mut Random, kind: ChainKind) -> Link {
    let mut pick = |values: &[[f64; 3]]| {
        let at = random.uniform(0.0, values.len() as f64);
        values[at as usize]
    };
    let (x, z) = ([0.2, 0.0, 0.0], [0.0, 0.0, -0.3]);
    let (point, needle) = ([0.0; 3], [0.1, 0.1, 0.0]);
    let inertia = match kind {
        ChainKind::Plane => pick(&[point, point, [0.1; 3]]),
        _ => pick(&[point, needle, needle, [0.1, 0.2, 0.3], [0.1; 3]]),
    };
    Link {
        at: pick(&[[0.0; 3], x, z, [0.1, 0.0, 0.2]]),
        mass: 1.0,
        cg: pick(&[[0.0; 3], x, z, [0.0, 0.0, -0.7]]),
        inertia,
        axes: match kind {
            ChainKind::Plane => [0.0; 3],
            _ => pick(&[[0.0; 3], [0.0; 3], [0.4, 0.3, 0.2]]),
        },
    }
}

/// A scaled pivot below this counts as zero; pivots are computed in double-double from numbers between 1e-3 and 1e3.
const ZERO: f64 = 1e-20;

fn random(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let trials = if bench.full() { 5000 } else { 300 };
    for kind in [ChainKind::Plane, ChainKind::Quaternion] {
        bench.variant(format!("{}, chains of 1 … 4 elements", kind.name()));
        let (mut singular, mut wrong) = (0u64, Vec::new());
        for trial in 0..trials {
            let mut random = Random::new(trial);
            let count = random.uniform(1.0, 5.0) as usize;
            let links: Vec<Link> = (0..count).map(|_| odd(&mut random, kind)).collect();
            let setting = Setting {
                kind,
                free: random.uniform(0.0, 1.0) < 0.4,
                loaded: false,
            };
            let read = scene(setting, &links).model();
            let model = bodies(setting, &links)?;
            let tree = Tree::of(&model)?;
            let pivot = (0..2)
                .map(|_| smallest_pivot(&tree, &random_state(&mut random, &model).0))
                .fold(0.0, f64::max);
            singular += u64::from(pivot < ZERO);
            if read.is_err() != (pivot < ZERO) {
                let seen = match read {
                    Ok(_) => "accepted".to_owned(),
                    Err(problems) => first_line(&problems.to_string()),
                };
                wrong.push(format!(
                    "trial {trial}: smallest pivot {pivot:.1e}, but {seen}: {}",
                    scene(setting, &links).text
                ));
            }
        }
        let agree = wrong.is_empty() && singular > 0 && singular < trials;
        let seen = match wrong.first() {
            Some(first) => format!("{} disagree, {first}", wrong.len()),
            None => format!("{singular} of {trials} singular and refused"),
        };
        bench.states(
            "all judged as L D Lᵀ judges",
            agree,
            seen,
            "zero is below 1e-20: pivots of order 1 in double-double, rounded to 1e-30",
        );
    }
    Ok(())
}

/// The model of a chain that may have to be refused: it is read with other moments of inertia, which are then replaced
/// by those of the links.
fn bodies(setting: Setting, links: &[Link]) -> Result<Model, Trouble> {
    let sound: Vec<Link> = links
        .iter()
        .map(|link| Link {
            // all moments differ, because principal axes that do not matter are dropped
            inertia: [0.1, 0.11, 0.12],
            ..*link
        })
        .collect();
    let read = scene(setting, &sound).model();
    let mut model = read.map_err(|problems| Trouble::Refused(problems.to_string()))?;
    let planar = model.dimension == Dimension::Plane;
    for (element, link) in model.systems[0].elements.iter_mut().zip(links) {
        for (i, moment) in element.inertia.iter_mut().enumerate() {
            if !planar || i == 1 {
                *moment = link.inertia[i].into();
            }
        }
    }
    Ok(model)
}
