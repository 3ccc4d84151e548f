//! Trees of hinges, sliders, screws, lists and welds. Their accelerations are computed in the frames of the links, and
//! checked by the residual of S v̇ = r in double-double.

use crate::bench::{Bench, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::evaluate::{Accelerations, Precise};
use crate::random::Random;
use bryant_generator::dynamics::{Options, derive_with};
use bryant_generator::equations::Route;
use bryant_generator::expression::evaluate::{Evaluator, Inputs, Scalar};
use bryant_generator::model::Model;
use std::fmt::Write;

pub const CASES: &[Case] = &[Case {
    group: Group::MassAndShape,
    name: "hinges, sliders, lists and welds",
    law: "v̇ comes from the cheapest formulation, in f64. It solves S v̇ = r for slightly changed S and r. The exact S and r come from the \
          velocity columns of the joints in absolute axes, in double-double.",
    run: hinges,
}];

/// Number of states of each tree.
const STATES: usize = 3;

/// An element of a chain: its joint, mass, and moments of inertia.
struct Link {
    joint: String,
    mass: f64,
    /// Size \[m\]: scales the distance to its joint and its inertia.
    size: f64,
    /// The value of its coordinate in all states; random if `None`.
    at: Option<f64>,
}

type Chain = fn(&mut Random, usize, usize) -> Link;

fn axis(random: &mut Random) -> String {
    let axis = [0, 1, 2].map(|_| random.uniform(-1.0, 1.0));
    format!("[{}, {}, {}]", axis[0], axis[1], axis[2])
}

fn hinge(random: &mut Random, mass: f64) -> Link {
    Link {
        joint: format!("{{ hinge: {} }}", axis(random)),
        mass,
        size: 1.0,
        at: None,
    }
}

fn tilted(random: &mut Random, k: usize, tilt: f64) -> Link {
    let [a, b] = [0, 1].map(|_| tilt * random.uniform(-1.0, 1.0));
    let axis = match k % 3 {
        0 => [1.0, a, b],
        1 => [a, b, 1.0],
        _ => [a, b, -1.0],
    };
    Link {
        joint: format!("{{ hinge: {axis:?} }}"),
        ..hinge(random, 1.0)
    }
}

/// A list of three hinges. The first and the last become parallel as the angle `middle` of the middle hinge goes to 0.
fn near_singular(random: &mut Random, middle: f64) -> Link {
    Link {
        joint: "[{ hinge: z, name: a }, { hinge: y, name: b }, { hinge: z, name: c }]".into(),
        at: Some(middle),
        ..hinge(random, 1.0)
    }
}

const CHAINS: [(&str, Chain); 19] = [
    ("hinges anywhere", |random, _, _| hinge(random, 1.0)),
    ("masses rising to 1e6 outboard", |random, k, n| {
        hinge(random, 1e6f64.powf(k as f64 / (n - 1) as f64))
    }),
    ("masses falling to 1e-6 outboard", |random, k, n| {
        hinge(random, 1e-6f64.powf(k as f64 / (n - 1) as f64))
    }),
    ("1e6 kg at the end", |random, k, n| {
        hinge(random, if k + 1 == n { 1e6 } else { 1.0 })
    }),
    ("1 and 1e6 kg in turn", |random, k, _| {
        hinge(random, if k.is_multiple_of(2) { 1.0 } else { 1e6 })
    }),
    ("a micrometre and a metre in turn", |random, k, _| Link {
        size: if k.is_multiple_of(2) { 1.0 } else { 1e-6 },
        ..hinge(random, 1.0)
    }),
    ("parallel axes", |random, _, _| Link {
        joint: "{ hinge: y }".into(),
        ..hinge(random, 1.0)
    }),
    ("right angles", |random, k, _| tilted(random, k, 0.0)),
    ("axes 1e-3 from right angles", |random, k, _| {
        tilted(random, k, 1e-3)
    }),
    ("axes 1e-6 from right angles", |random, k, _| {
        tilted(random, k, 1e-6)
    }),
    ("axes 1e-8 from right angles", |random, k, _| {
        tilted(random, k, 1e-8)
    }),
    ("axes 1e-11 from right angles", |random, k, _| {
        tilted(random, k, 1e-11)
    }),
    ("axes 1e-14 from right angles", |random, k, _| {
        tilted(random, k, 1e-14)
    }),
    ("sliders and hinges in turn", |random, k, _| Link {
        joint: match k % 2 {
            0 => format!("{{ slider: {} }}", axis(random)),
            _ => format!("{{ hinge: {} }}", axis(random)),
        },
        ..hinge(random, 1.0)
    }),
    ("screws of small and large pitch", |random, k, _| Link {
        joint: format!(
            "{{ screw: {}, pitch: {} }}",
            axis(random),
            if k.is_multiple_of(2) { 1e-4 } else { 10.0 }
        ),
        ..hinge(random, 1.0)
    }),
    ("lists 1e-2 from their singular position", |random, _, _| {
        near_singular(random, 1e-2)
    }),
    ("lists 1e-4 from their singular position", |random, _, _| {
        near_singular(random, 1e-4)
    }),
    ("welds of 1e-9 kg between hinges", |random, k, _| {
        match k % 2 {
            0 => hinge(random, 1.0),
            _ => Link {
                joint: "weld".into(),
                ..hinge(random, 1e-9)
            },
        }
    }),
    (
        "gears of 1 to 1000, rotors of 1 kg m²",
        |random, k, _| match k {
            // in a floating system, this element is on a ball joint instead
            0 | 1 => Link {
                joint: "{ hinge: y, armature: 1 }".into(),
                ..hinge(random, 1.0)
            },
            _ => Link {
                joint: format!(
                    "{{ hinge: {}, follows: {{ joint: e{}, ratio: {} }}, armature: 1e-6 }}",
                    axis(random),
                    k - 1,
                    if k.is_multiple_of(2) { 1e3 } else { 1e-3 },
                ),
                ..hinge(random, 1.0)
            },
        },
    ),
];

fn hinges(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let counts: &[usize] = match bench.full() {
        false => &[2, 7],
        true => &[2, 3, 5, 8, 16, 32],
    };
    for (name, chain) in CHAINS {
        bench.variant(name);
        let mut random = Random::new(7);
        let (mut plain, mut scaled, mut trees) = (0.0f64, 0.0f64, 0);
        for &n in counts {
            let references: &[&str] = match (bench.full(), n % 2) {
                (true, _) => &["fixed", "free"],
                (false, 0) => &["fixed"],
                _ => &["free"],
            };
            for reference in references {
                let links: Vec<Link> = (0..n).map(|k| chain(&mut random, k, n)).collect();
                let model = model(&mut random, reference, &links)?;
                for _ in 0..STATES {
                    let found = backward_error(&model, &mut random, &links);
                    (plain, scaled) = (worst(plain, found[0]), worst(scaled, found[1]));
                }
                trees += 1;
            }
        }
        let states = format!("{trees} chains in {STATES} random states");
        bench.at_most(
            "backward error over n ε",
            plain,
            100.0,
            "",
            format!("100 n ε, required; the worst of {states}"),
        );
        bench.at_most(
            "backward error over n ε, S scaled to a diagonal of ones",
            scaled,
            100.0,
            "",
            format!(
                "100 n ε, required for each velocity relative to its own size; the worst of {states}"
            ),
        );
    }
    Ok(())
}

/// The larger value; NaN is kept.
fn worst(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

fn model(random: &mut Random, reference: &str, links: &[Link]) -> Result<Model, Trouble> {
    let mut text = format!(
        "model: chain\ndimension: 3\nsystems:\n  - name: s\n    reference: {reference}\n    elements:\n"
    );
    for (k, link) in links.iter().enumerate() {
        let vector =
            |random: &mut Random| [0, 1, 2].map(|_| 0.3 * link.size * random.uniform(-1.0, 1.0));
        let on = match k {
            0 => String::new(),
            _ => format!("on: e{}, at: {:?}, ", k - 1, vector(random)),
        };
        // the first element of a floating system is on a ball joint
        let joint = match (k, reference) {
            (0, "free") => "ball",
            _ => &link.joint,
        };
        let moments = [0.11, 0.09, 0.07].map(|m| m * link.mass * link.size * link.size);
        let _ = writeln!(
            text,
            "      - {{ name: e{k}, {on}joint: {joint}, mass: {}, cg: {:?}, inertia: {moments:?}, axes: [0.3, -0.2, 0.5] }}",
            link.mass,
            vector(random),
        );
    }
    text += "forces: [{ field: gravity, acceleration: [1, 2, -9.81] }]\nrun: { duration: 1 s, every: 0.1 s }\n";
    let scene = CaseModel::new("chain", text);
    scene
        .model()
        .map_err(|problems| Trouble::Refused(problems.to_string()))
}

/// |S v̇ − r| over n ε and over the largest possible terms, from the sizes of S, v̇ and the squares of v. The first
/// result takes the largest entries of the whole system, the second each row alone with S scaled to a unit diagonal.
fn backward_error(model: &Model, random: &mut Random, links: &[Link]) -> [f64; 2] {
    let exact = derive_with(
        model,
        Options {
            matrices: true,
            route: Some(Route::MassMatrix),
        },
    );
    let n = exact.velocities.len();
    let middle: Vec<Option<f64>> = (exact.coordinates.iter())
        .map(|variable| {
            let link = &links[variable.element?];
            variable.name.ends_with(".b").then_some(link.at).flatten()
        })
        .collect();
    let mut q: Vec<f64> = middle
        .iter()
        .map(|at| at.unwrap_or_else(|| random.uniform(-1.2, 1.2)))
        .collect();
    for range in &exact.quaternions {
        let length = q[range.clone()].iter().map(|x| x * x).sum::<f64>().sqrt();
        q[range.clone()].iter_mut().for_each(|x| *x /= length);
    }
    let v: Vec<f64> = (0..n).map(|_| random.uniform(-2.0, 2.0)).collect();
    let rates = Accelerations::<f64>::by_elimination(model).at(&q, &v);

    let mut roots = exact.mass_matrix.concat();
    roots.extend(&exact.velocity_forces);
    roots.extend(&exact.applied_forces);
    let [q, v] = [&q, &v].map(|values| {
        values
            .iter()
            .map(|x| Precise::from_f64(*x))
            .collect::<Vec<_>>()
    });
    let inputs = Inputs {
        time: Precise::from_f64(0.0),
        coordinates: &q,
        velocities: &v,
        parameters: &[],
        auxiliaries: &[],
        memory: &[],
        accelerations: &[],
    };
    let mut evaluator = Evaluator::<Precise>::new(&exact.graph, &roots);
    let found = evaluator
        .evaluate(&inputs, &|_, _: &[Precise]| Precise::from_f64(f64::NAN))
        .to_vec();
    let (s, r) = found.split_at(n * n);
    let f64_of = |x: Precise| x.0.parts()[0].abs();
    let speed = v.iter().map(|v| f64_of(*v)).fold(0.0, f64::max);
    let root: Vec<f64> = (0..n).map(|i| f64_of(s[i * n + i]).sqrt()).collect();
    let force = |i: usize| f64_of(r[i]).max(f64_of(r[n + i]));
    let residual: Vec<f64> = (0..n)
        .map(|i| {
            let right = r[i] + r[n + i];
            let rest = (0..n).fold(right, |rest, j| {
                rest - s[i * n + j] * Precise::from_f64(rates[j])
            });
            f64_of(rest)
        })
        .collect();
    let largest = |of: &dyn Fn(usize) -> f64| (0..n).map(of).fold(0.0, worst);
    let unit = n as f64 * f64::EPSILON;
    // a bias force is a column times an inertia times two rates. For a follower with a ratio, column and rates are
    // larger by the ratio, and S contains two of these three factors already.
    let systems = model.systems.iter().flat_map(|system| system.freedoms());
    let ratios = systems.filter_map(|freedom| freedom.follows.as_ref());
    let fastest = ratios.fold(1.0f64, |most, f| most.max(f.ratio.value(&[]).abs()));
    let motion = |j: usize| rates[j].abs() + fastest * speed * speed;
    let row = |i: usize| {
        (0..n)
            .map(|j| f64_of(s[i * n + j]) * motion(j))
            .sum::<f64>()
    };
    let plain = largest(&|i| residual[i]) / (largest(&row) + largest(&force));
    let whole: f64 =
        (0..n).map(|j| root[j] * motion(j)).sum::<f64>() + largest(&|i| force(i) / root[i]);
    let scaled = largest(&|i| residual[i] / root[i]) / whole;
    [plain / unit, scaled / unit]
}
