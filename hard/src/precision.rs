//! Changes that must not affect results: units, the origin, directions, the order and the root of a tree, other
//! systems, the direction of time. Single precision may affect results only as far as its digits say.

use crate::bench::{Bench, Run, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::jobs::{adaptive, fixed, name};
use crate::measure::{largest, steps};
use crate::tree::{Tree, rotation};
use bryant_runtime::program::{Job, Scalar};
use bryant_runtime::{Formula, Tolerances};

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::ScaleAndPrecision,
        name: "grams and millimetres",
        law: "A scene that is written in other units, or with numbers a thousand times larger, moves as before.",
        run: units,
    },
    Case {
        group: Group::ScaleAndPrecision,
        name: "an origin 1000 km away",
        law: "Forces depend on distances alone. So a scene that is displaced as a whole moves as before, except for the rounding of its \
              larger coordinates.",
        run: far_away,
    },
    Case {
        group: Group::ScaleAndPrecision,
        name: "single precision",
        law: "The errors are those of 24 bits: 2²⁹ times the errors of 53 bits, and no larger.",
        run: single_precision,
    },
    Case {
        group: Group::ScaleAndPrecision,
        name: "order, root and direction of a tree",
        law: "The motion stays the same if the elements of a tree are written in another order or from another root, or if the scene is \
              turned in space.",
        run: order_root_direction,
    },
    Case {
        group: Group::ScaleAndPrecision,
        name: "time reversed",
        law: "Without losses, a motion with reversed velocities leads back to the start.",
        run: time_reversed,
    },
    Case {
        group: Group::ScaleAndPrecision,
        name: "two systems in one scene",
        law: "Two systems without a force between them move as each does alone.",
        run: two_systems,
    },
];

/// Units of length and mass in the text of a scene, as numbers per SI unit; if not `named`, no units are written.
#[derive(Clone, Copy)]
struct Units {
    length: f64,
    mass: f64,
    named: bool,
}

impl Units {
    fn text(self, value: f64, length: i32, mass: i32, unit: &str) -> String {
        let number = value * self.length.powi(length) * self.mass.powi(mass);
        match self.named {
            true => format!("{number:e} {unit}"),
            false => format!("{number:e}"),
        }
    }

    /// A length in metres, as text in the unit.
    fn m(self, value: f64) -> String {
        self.text(value, 1, 0, "mm")
    }
}

/// Two rotating links that fall onto a rough plate; everything is moved by `away` \[m\] along both axes.
fn links(name: &str, units: Units, away: f64) -> CaseModel {
    let m = |value| units.m(value);
    let kg = |value| units.text(value, 0, 1, "g");
    let speed = |value| units.text(value, 1, 0, "mm/s");
    let inertia = |value| units.text(value, 2, 1, "g*mm^2");
    let field = |value| units.text(value, 1, 0, "mm/s^2");
    // forces have units if units are named, and else the product of the factors
    let newton = |value: f64| match units.named {
        true => format!("{value:e} N"),
        false => units.text(value, 1, 1, ""),
    };
    let dashpot = |value: f64| match units.named {
        true => format!("{value:e} N*s/m"),
        false => units.text(value, 0, 1, ""),
    };
    let torque = |value: f64| match units.named {
        true => format!("{value:e} N*m*s/rad"),
        false => units.text(value, 2, 1, ""),
    };
    let contact = |name: &str, element: &str, x: f64| {
        format!(
            "  - contact: {name}
    ellipsoid: {{ on: links/{element}, center: [{}, {}], semi_axes: [{}, {}] }}
    plane: {{ on: frame, at: [{}, {}], normal: [0.1, 1] }}
    elastic: {{ points: [[{}, {}], [{}, {}]], extrapolate: linear }}
    damping: {}
    damping_depth: {}
    friction: 0.3
    friction_speed: {}
    friction_displacement: {}
",
            m(x),
            m(0.0),
            m(0.15),
            m(0.05),
            m(away),
            m(away),
            m(0.0),
            newton(0.0),
            m(1.0),
            newton(1e5),
            dashpot(50.0),
            m(2e-3),
            speed(0.02),
            m(2e-4)
        )
    };
    let text = format!(
        "model: {name}
dimension: 2
systems:
  - name: links
    elements:
      - {{ name: upper, mass: {}, cg: [{}, {}], inertia: {} }}
      - {{ name: lower, on: upper, at: [{}, {}], mass: {}, cg: [{}, {}], inertia: {} }}
    start:
      position: [{}, {}]
      velocity: [{}, {}]
      angles: {{ upper: 0.3 rad, lower: -0.5 rad }}
      rates: {{ upper: 1 rad/s, lower: -2 rad/s }}
forces:
  - {{ field: gravity, acceleration: [0, {}] }}
  - {{ joint: links/lower, damping: {} }}
{}{}run: {{ duration: 0.5 s, every: 10 ms }}
",
        kg(2.0),
        m(0.1),
        m(0.01),
        inertia(0.02),
        m(0.25),
        m(0.0),
        kg(1.0),
        m(0.1),
        m(-0.01),
        inertia(0.01),
        m(away),
        m(away + 0.3),
        speed(1.0),
        speed(-0.5),
        field(-9.81),
        torque(0.05),
        contact("near", "upper", 0.05),
        contact("far", "lower", 0.1),
    );
    CaseModel::new(name, text)
}

const SI: Units = Units {
    length: 1.0,
    mass: 1.0,
    named: false,
};

/// Frequency of the lighter link on its contact \[1/s\], and an upper bound of speeds \[m/s\], for [`links`].
const OMEGA: f64 = 316.0;
const SPEED: f64 = 10.0;

/// The largest difference of coordinates at any sample. `names` has the name of each, and the factor and shift of its
/// values in the second run.
fn apart(a: &Run, b: &Run, names: &[(&str, f64, f64)]) -> Result<f64, Trouble> {
    let mut worst = 0.0;
    for (name, factor, moved) in names {
        let (a, b) = (a.state(name)?, b.state(name)?);
        if a.len() != b.len() {
            return Err(Trouble::Case("runs of unequal length".into()));
        }
        let differences = a
            .iter()
            .zip(&b)
            .map(|(a, b)| (a - (b / factor - moved)).abs());
        worst = largest(differences.chain([worst]));
    }
    Ok(worst)
}

const COORDINATES: [&str; 4] = ["links.x", "links.z", "links/upper.phi", "links/lower.phi"];

fn units(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let job = fixed(Formula::Rk4, 1e-4);
    let si = bench.succeed(&links("links-si", SI, 0.0), &job)?;
    let told = [
        ("in g and mm", 1.0, true),
        ("every number in g and mm, without a unit", 1e3, false),
    ];
    for (variant, factor, named) in told {
        bench.variant(variant);
        let units = Units {
            length: 1e3,
            mass: 1e3,
            named,
        };
        let name = if named { "links-mm" } else { "links-scaled" };
        let other = bench.succeed(&links(name, units, 0.0), &job)?;
        let names = [(factor, 0), (factor, 1), (1.0, 2), (1.0, 3)];
        let names = names.map(|(factor, i)| (COORDINATES[i], factor, 0.0));
        bench.at_most(
            "difference of any coordinate",
            apart(&si, &other, &names)?,
            steps(&si)? * f64::EPSILON * SPEED * OMEGA,
            "m, rad",
            "steps × ε v ω: every number is rounded once more, and so is each step",
        );
    }
    Ok(())
}

fn far_away(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let away = 1e6;
    // rounding error: half a unit in the last place of 10⁶ m
    let rounding = away * 0.5 * f64::EPSILON;
    let (here, there) = (links("links-si", SI, 0.0), links("links-far", SI, away));
    let names = [away, away, 0.0, 0.0];
    let names: Vec<(&str, f64, f64)> = (COORDINATES.into_iter().zip(names))
        .map(|(name, moved)| (name, 1.0, moved))
        .collect();

    bench.variant("rk4 at 0.1 ms");
    let step = 1e-4;
    let [a, b] = [
        bench.succeed(&here, &fixed(Formula::Rk4, step))?,
        bench.succeed(&there, &fixed(Formula::Rk4, step))?,
    ];
    // A rounding error of the height causes a wrong force during one step, and this a wrong speed for the rest of the
    // run.
    let duration = 0.5;
    bench.at_most(
        "difference of any coordinate",
        apart(&a, &b, &names)?,
        steps(&a)? * 4.0 * rounding * (1.0 + OMEGA * OMEGA * step * duration),
        "m, rad",
        "steps × ε |x| (1 + ω² h T), four stages: a rounded height is a wrong force for a step, and so a wrong speed",
    );

    bench.variant("dopri5 at 1e-9");
    let job = adaptive(Formula::Dopri5, Tolerances::of(1e-9));
    let [a, b] = [bench.succeed(&here, &job)?, bench.succeed(&there, &job)?];
    let count = steps(&a)? + steps(&b)?;
    bench.at_most(
        "difference of any coordinate",
        apart(&a, &b, &names)?,
        count * (1e-9 * (1.0 + SPEED) + rounding * OMEGA) * OMEGA * duration,
        "m, rad",
        "steps of both × (tolerance × (1 + v) + ε |x| ω) ω T",
    );
    Ok(())
}

fn single_precision(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = links("links-si", SI, 0.0);
    let names = COORDINATES.map(|name| (name, 1.0, 0.0));
    let epsilon = f64::from(f32::EPSILON);
    for step in [1e-3, 1e-4] {
        bench.variant(format!("rk4 at {step} s"));
        let double = bench.succeed(&scene, &fixed(Formula::Rk4, step))?;
        let job = Job {
            scalar: Scalar::F32,
            ..fixed(Formula::Rk4, step)
        };
        let single = bench.succeed(&scene, &job)?;
        let apart = apart(&double, &single, &names)?;
        bench.at_most(
            "difference from double precision",
            apart,
            steps(&double)? * epsilon * SPEED * OMEGA,
            "m, rad",
            "steps × ε v ω, ε = 2⁻²³",
        );
        bench.at_least(
            "difference from double precision",
            apart,
            0.5 * epsilon * 0.1,
            "m, rad",
            "a coordinate of a decimetre is rounded",
        );
    }
    Ok(())
}

/// The largest growth of an error of the start until the end, measured with errors that are a million times those of
/// the method.
fn growth(
    bench: &Bench<'_>,
    (tree, scene): (&Tree, &CaseModel),
    job: &Job,
    reference: &Run,
) -> Result<f64, Trouble> {
    let error = 1e-6;
    let mut worst: f64 = 1.0;
    for element in &tree.elements {
        let nudged = ["turn", "spin"].map(|what| (format!("{what}_{}", element.name), error));
        let job = Job {
            parameters: nudged.to_vec(),
            ..job.clone()
        };
        let run = bench.succeed(scene, &job)?;
        worst = worst.max(positions_apart(reference, &run, tree, STRAIGHT)? / error);
    }
    Ok(worst)
}

/// No rotation.
const STRAIGHT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The largest distance between centres of gravity of the same element in two runs, after those of the second run are
/// rotated by a matrix.
fn positions_apart(a: &Run, b: &Run, tree: &Tree, turned: [[f64; 3]; 3]) -> Result<f64, Trouble> {
    let mut worst = 0.0;
    for element in &tree.elements {
        let of = |run: &Run| -> Result<[Vec<f64>; 3], Trouble> {
            let name = |axis: &str| format!("{} {axis}", element.name);
            Ok([
                run.output(&name("x"))?,
                run.output(&name("y"))?,
                run.output(&name("z"))?,
            ])
        };
        let (a, b) = (of(a)?, of(b)?);
        for sample in 0..a[0].len() {
            for (row, a) in turned.iter().zip(&a) {
                let b: f64 = row.iter().zip(&b).map(|(r, b)| r * b[sample]).sum();
                worst = largest([worst, (a[sample] - b).abs()]);
            }
        }
    }
    Ok(worst)
}

fn order_root_direction(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let tree = Tree::example();
    let tolerance = 1e-12;
    let job = adaptive(Formula::Dop853, Tolerances::of(tolerance));
    let scene = tree.scene("tree");
    let reference = bench.succeed(&scene, &job)?;
    let rough = adaptive(Formula::Dop853, Tolerances::of(1e-10));
    let growth = growth(bench, (&tree, &scene), &rough, &reference)?;
    let turn = rotation([0.7, -1.1, 2.3]);
    let back = [0, 1, 2].map(|i| [0, 1, 2].map(|j| turn[j][i]));
    let told = [
        ("elements in another order", tree.permuted(), STRAIGHT),
        (
            "from another root",
            tree.rooted_at(tree.elements.len() - 1),
            STRAIGHT,
        ),
        ("turned in space", tree.turned(&turn), back),
    ];
    for (index, (variant, other, turned)) in told.into_iter().enumerate() {
        bench.variant(variant);
        let run = bench.succeed(&other.scene(&format!("tree-told-{index}")), &job)?;
        let count = steps(&reference)? + steps(&run)?;
        bench.at_most(
            "distance of any centre of gravity",
            positions_apart(&reference, &run, &tree, turned)?,
            count * tolerance * (1.0 + 5.0) * growth,
            "m",
            format!(
                "steps of both × tolerance × (1 + v) × growth of an error of the start, {growth:.0}"
            ),
        );
    }
    Ok(())
}

/// The names of the angles and rates of a double pendulum at its start.
const START: [&str; 4] = ["upper_angle", "lower_angle", "upper_rate", "lower_rate"];

/// A double pendulum with an arbitrary start.
fn pendulum() -> CaseModel {
    let text = "model: pendulum-there-and-back
dimension: 2
parameters:
  upper_angle: { value: 0 rad, min: -100 rad, max: 100 rad }
  lower_angle: { value: 0 rad, min: -100 rad, max: 100 rad }
  upper_rate: { value: 0 rad/s, min: -100 rad/s, max: 100 rad/s }
  lower_rate: { value: 0 rad/s, min: -100 rad/s, max: 100 rad/s }
systems:
  - name: arm
    reference: fixed
    elements:
      - { name: upper, mass: 1 kg, cg: [0, -0.5 m], inertia: 0.08 }
      - { name: lower, on: upper, at: [0, -1 m], mass: 1 kg, cg: [0, -0.5 m], inertia: 0.08 }
    start: { angles: { upper: upper_angle, lower: lower_angle }, rates: { upper: upper_rate, lower: lower_rate } }
forces:
  - { field: gravity, acceleration: [0, -9.81 m/s^2] }
run: { duration: 3 s, every: 0.1 s }
";
    CaseModel::new("pendulum-there-and-back", text)
}

fn time_reversed(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let start = [-1.5, -1.2, 0.3, -0.4];
    let scene = pendulum();
    for (formula, tolerance) in [(Formula::Dopri5, 1e-10), (Formula::Dop853, 1e-13)] {
        bench.variant(name(formula, tolerance));
        let from = |y: [f64; 4]| {
            let named = START.iter().zip(y);
            let job = Job {
                parameters: named
                    .map(|(name, value)| (name.to_string(), value))
                    .collect(),
                ..adaptive(formula, Tolerances::of(tolerance))
            };
            bench.succeed(&scene, &job)
        };
        let end = |run: &Run, sign: f64| -> Result<[f64; 4], Trouble> {
            let y = run.last()?;
            Ok([y[0], y[1], sign * y[2], sign * y[3]])
        };
        let there = from(start)?;
        let turned = end(&there, -1.0)?;
        let back_run = from(turned)?;
        // growth of an error at the turning point
        let nudge = 1e-6;
        let mut growth: f64 = 1.0;
        for i in 0..4 {
            let mut nudged = turned;
            nudged[i] += nudge;
            let run = from(nudged)?;
            let (a, b) = (end(&run, 1.0)?, end(&back_run, 1.0)?);
            growth = growth.max(largest(a.iter().zip(b).map(|(a, b)| (a - b).abs())) / nudge);
        }
        let found = end(&back_run, -1.0)?;
        let away = found.iter().zip(start).map(|(a, b)| (a - b).abs());
        let count = steps(&there)? + steps(&back_run)?;
        let bound = count * tolerance * (1.0 + 10.0) * growth * growth;
        bench.at_most(
            "distance from the start",
            largest(away),
            bound,
            "rad, rad/s",
            format!(
                "steps there and back × tolerance × (1 + φ') × growth {growth:.1}², on either way"
            ),
        );
    }
    Ok(())
}

fn two_systems(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let mut other = Tree::example();
    for element in &mut other.elements {
        element.mass *= 1.5;
        element.angles = [0.3, -0.2, 0.1];
    }
    let (a, b) = (Tree::example(), other);
    let job = fixed(Formula::Rk4, 1e-3);
    let [first, second] = [a.scene("tree"), b.scene("tree-other")];
    let alone = [bench.succeed(&first, &job)?, bench.succeed(&second, &job)?];
    let together = bench.succeed(&Tree::scene_of_two("tree-two", &a, &b), &job)?;
    let grows = [
        growth(bench, (&a, &first), &job, &alone[0])?,
        growth(bench, (&b, &second), &job, &alone[1])?,
    ];
    let growth = grows[0].max(grows[1]);
    for (index, alone) in alone.iter().enumerate() {
        bench.variant(["the first", "the second"][index]);
        let mut worst = 0.0;
        for (column, output) in alone.header.outputs.iter().enumerate() {
            let name = match index {
                0 => output.name.clone(),
                _ => format!("other {}", output.name),
            };
            let found = together.output(&name)?;
            let pairs = alone.outputs.iter().map(|row| row[column]).zip(found);
            worst = largest(pairs.map(|(a, b)| (a - b).abs()).chain([worst]));
        }
        bench.at_most(
            "distance of any centre of gravity",
            worst,
            steps(alone)? * f64::EPSILON * (1.0 + 5.0) * growth,
            "m",
            format!("steps × ε (1 + v) × growth of an error of the start, {growth:.0}: the same operations, perhaps in another order"),
        );
    }
    Ok(())
}
