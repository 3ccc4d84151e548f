//! Ratios of masses, vanishing moments of inertia, coincident joints: S is far from a multiple of the unit matrix, and
//! may be singular.

mod singular;

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::chain::{ChainKind, Link, Setting, general};
use crate::random::Random;
use crate::survey::Survey;

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::MassAndShape,
        name: "mass ratios along a chain",
        law: "S v̇ = r holds for any masses. The computed v̇ solves this equation for slightly changed S and r. The change is measured by \
              the residual of d'Alembert's principle, body by body, in double-double.",
        run: mass_ratios,
    },
    Case {
        group: Group::MassAndShape,
        name: "needles, plates, points and joints that coincide",
        law: "S v̇ = r holds for any shapes. The computed v̇ solves this equation for slightly changed S and r. The change is measured by \
              the residual of d'Alembert's principle, body by body, in double-double.",
        run: shapes,
    },
    singular::REFUSED,
    singular::RANDOM,
];

/// The mass of element k of n.
type Mass = fn(usize, usize) -> f64;

const RATIOS: [(&str, Mass); 7] = [
    ("rising to 1e6 outboard", |k, n| {
        1e6f64.powf(k as f64 / (n - 1) as f64)
    }),
    ("falling to 1e-6 outboard", |k, n| {
        1e-6f64.powf(k as f64 / (n - 1) as f64)
    }),
    ("1e6 at the end", |k, n| if k + 1 == n { 1e6 } else { 1.0 }),
    (
        "1e-6 at the end",
        |k, n| if k + 1 == n { 1e-6 } else { 1.0 },
    ),
    ("1e6 at the root", |k, _| if k == 0 { 1e6 } else { 1.0 }),
    ("1e-6 at the root", |k, _| if k == 0 { 1e-6 } else { 1.0 }),
    ("1 and 1e6 in turn", |k, _| {
        if k.is_multiple_of(2) { 1.0 } else { 1e6 }
    }),
];

fn mass_ratios(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let counts: &[usize] = match bench.full() {
        false => &[2, 3, 10, 30],
        true => &[2, 3, 4, 5, 7, 10, 15, 20, 30, 50, 70, 100],
    };
    for (name, mass) in RATIOS {
        let longest = counts.iter().max().copied().unwrap_or(0);
        bench.variant(format!("masses {name}, 2 … {longest} elements"));
        over(bench, counts, &|random, k, n| general(random, mass(k, n)))?;
    }
    Ok(())
}

/// Makes an element from the random generator, its index, and the length of the chain.
type Maker<'a> = &'a dyn Fn(&mut Random, usize, usize) -> Link;

/// Tests chains of these elements, in all coordinates, free and fixed, with and without a load.
fn over(bench: &mut Bench<'_>, counts: &[usize], make: Maker<'_>) -> Result<(), Trouble> {
    let mut survey = Survey::default();
    for kind in ChainKind::ALL {
        for loaded in [false, true] {
            for (i, &count) in counts.iter().enumerate() {
                let mut random = Random::new(count as u64);
                let links: Vec<Link> = (0..count).map(|k| make(&mut random, k, count)).collect();
                let setting = Setting {
                    kind,
                    free: i.is_multiple_of(2) != loaded,
                    loaded,
                };
                survey.take(&mut random, setting, &links)?;
            }
        }
    }
    survey.note(bench);
    Ok(())
}

/// Makes element k of 1 kg with a special shape; its other properties are general.
type Shape = fn(&mut Random, usize) -> Link;

const SHAPES: [(&str, Shape); 14] = [
    (
        "nearly a point beside its arm: moments times 1e-8",
        |random, _| {
            let link = general(random, 1.0);
            let inertia = link.inertia.map(|moment| 1e-8 * moment);
            Link { inertia, ..link }
        },
    ),
    (
        "needles without moment about an axis beside the joint",
        |random, k| Link {
            // without this moment, the root of a floating system could rotate about its third axis without kinetic
            // energy
            inertia: [0.01, 0.01, if k == 0 { 0.005 } else { 0.0 }],
            ..general(random, 1.0)
        },
    ),
    ("needles of 1e-9 anywhere", |random, _| Link {
        inertia: [0.01, 0.01, 1e-11],
        ..general(random, 1.0)
    }),
    ("needles of 1e-9 along the chain", |random, _| Link {
        inertia: [0.01, 0.01, 1e-11],
        cg: [0.0, 0.0, random.uniform(-0.2, -0.1)],
        at: [0.0, 0.0, random.uniform(-0.4, -0.2)],
        axes: [0.0; 3],
        ..general(random, 1.0)
    }),
    (
        "needles of 1e-9, a micrometre beside the chain",
        |random, _| Link {
            inertia: [0.01, 0.01, 1e-11],
            cg: [1e-6, 0.0, random.uniform(-0.2, -0.1)],
            at: [0.0, 1e-6, random.uniform(-0.4, -0.2)],
            axes: [0.0; 3],
            ..general(random, 1.0)
        },
    ),
    ("plates: J₁ + J₂ = J₃", |random, _| {
        let [first, second] = [0, 1].map(|_| random.uniform(0.001, 0.02));
        Link {
            inertia: [first, second, first + second],
            ..general(random, 1.0)
        }
    }),
    ("moments that differ by rounding", |random, _| Link {
        inertia: [0.01 * (1.0 + 4e-16), 0.01, 0.01 * (1.0 + 1e-12)],
        ..general(random, 1.0)
    }),
    ("all joints at one point", |random, _| Link {
        at: [0.0; 3],
        ..general(random, 1.0)
    }),
    ("joints a micrometre apart", |random, _| {
        let link = general(random, 1.0);
        let at = link.at.map(|a| 1e-6 * a);
        Link { at, ..link }
    }),
    ("joints a centimetre apart", |random, _| {
        let link = general(random, 1.0);
        let at = link.at.map(|a| 0.03 * a);
        Link { at, ..link }
    }),
    (
        "centre of gravity metres outside of the element",
        |random, _| {
            let link = general(random, 1.0);
            let cg = link.cg.map(|c| 30.0 * c);
            Link { cg, ..link }
        },
    ),
    ("centre of gravity behind the joint", |random, _| {
        let link = general(random, 1.0);
        let cg = link.at.map(|a| -5.0 * a);
        Link { cg, ..link }
    }),
    ("centre of gravity in the joint", |random, _| Link {
        cg: [0.0; 3],
        ..general(random, 1.0)
    }),
    ("centre of gravity in the joint outboard", |random, _| {
        // the joints of all elements coincide
        let at = [0.1, -0.2, 0.3];
        Link {
            cg: at,
            at,
            ..general(random, 1.0)
        }
    }),
];

fn shapes(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let counts: &[usize] = match bench.full() {
        false => &[1, 2, 3, 10],
        true => &[1, 2, 3, 4, 5, 10, 20, 50, 100],
    };
    for (name, shape) in SHAPES {
        bench.variant(name);
        over(bench, counts, &|random, k, _| shape(random, k))?;
    }
    bench.variant("1e-9 kg at the end of a chain");
    over(bench, counts, &|random, k, n| {
        general(random, if k + 1 == n && n > 1 { 1e-9 } else { 1.0 })
    })
}
