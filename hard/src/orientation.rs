//! Angles at their poles, tumbling, fast spin.

use crate::bench::{Bench, Run, Trouble};
use crate::case::{Case, Group};
use crate::case_model::CaseModel;
use crate::jobs::{adaptive, many, name, with_kinks};
use crate::measure::{error_of_speed, largest, steps};
use crate::tree::Tree;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Tolerances};

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::Orientation,
        name: "driven exactly through ±90°",
        law: "A body that turns steadily about y passes the poles of its second Bryant angle every half turn. In angles and in quaternions \
              its points follow p(t), which is p(0) turned by ω t.",
        run: through_the_poles,
    },
    Case {
        group: Group::Orientation,
        name: "a tumbling tree in angles and in quaternions",
        law: "Bryant angles and quaternions describe the same motion.",
        run: angles_and_quaternions,
    },
    Case {
        group: Group::Orientation,
        name: "a tumbling tree for 100 000 steps",
        law: "In free flight energy, momentum and angular momentum are conserved.",
        run: tumbles,
    },
    Case {
        group: Group::Orientation,
        name: "Dzhanibekov's flips",
        law: "A body that is thrown about its middle principal axis turns over again and again. In its own axes ω follows Jacobi's \
              elliptic functions (Landau & Lifshitz I, § 37).",
        run: flips,
    },
    Case {
        group: Group::Orientation,
        name: "spin at 10 000 rad/s",
        law: "The axis of a free symmetric top precesses about its angular momentum L at the rate L/J₁.",
        run: spins,
    },
    Case {
        group: Group::Orientation,
        name: "a quaternion after a million steps",
        law: "The quaternion is scaled back to length 1 after every step.",
        run: stays_a_unit,
    },
    Case {
        group: Group::Orientation,
        name: "a change of chart in the middle of a contact",
        law: "Forces do not depend on the chart of the angles.",
        run: chart_in_contact,
    },
];

/// A free body whose centre of gravity is its origin; `rest` is the text that follows.
fn body(name: &str, coordinates: &str, inertia: [f64; 3], rate: [f64; 3], rest: &str) -> CaseModel {
    let text = format!(
        "model: {name}
dimension: 3
coordinates: {coordinates}
systems:
  - name: top
    elements:
      - {{ name: body, mass: 1 kg, cg: [0, 0, 0], inertia: {inertia:?} }}
    start: {{ position: [0, 0, 0.1], rates: {{ body: {rate:?} }} }}
{rest}"
    );
    CaseModel::new(name, text)
}

/// A point of the body, and an upper bound of its distance from the origin \[m\].
const POINT: [f64; 3] = [0.1, 0.2, 0.3];
const LONGEST: f64 = 0.4;

fn outputs_of_point() -> String {
    let axis = |axis| {
        format!(
            "  - {{ name: p{axis}, of: top/body, at: {POINT:?}, what: position, component: {axis} }}\n"
        )
    };
    format!("outputs:\n{}", ["x", "y", "z"].map(axis).concat())
}

fn point(run: &Run) -> Result<[Vec<f64>; 3], Trouble> {
    Ok([run.output("px")?, run.output("py")?, run.output("pz")?])
}

/// The largest difference of any output at any sample.
fn apart(a: &Run, b: &Run) -> f64 {
    let rows = a.outputs.iter().zip(&b.outputs);
    largest(rows.flat_map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b).abs())))
}

fn through_the_poles(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let rate = 5.0;
    let run_of = "run: { duration: 10 s, every: 0.1 s }\n";
    let rest = format!("{}{run_of}", outputs_of_point());
    let tolerance = 1e-13;
    for coordinates in ["bryant", "quaternion"] {
        for formula in [Formula::Dop853, Formula::Dopri5] {
            bench.variant(format!("{coordinates}, {}", name(formula, tolerance)));
            let name = format!("pole-{coordinates}");
            let scene = body(
                &name,
                coordinates,
                [0.03, 0.04, 0.02],
                [0.0, rate, 0.0],
                &rest,
            );
            let run = bench.succeed(&scene, &adaptive(formula, Tolerances::of(tolerance)))?;
            let [x, y, z] = point(&run)?;
            let errors = run.times.iter().enumerate().map(|(i, t)| {
                let (sin, cos) = (rate * t).sin_cos();
                let exact = [
                    POINT[0] * cos + POINT[2] * sin,
                    POINT[1],
                    0.1 - POINT[0] * sin + POINT[2] * cos,
                ];
                largest([x[i] - exact[0], y[i] - exact[1], z[i] - exact[2]].map(f64::abs))
            });
            bench.at_most(
                "error of a point",
                largest(errors),
                1e-10,
                "m",
                "the demand; about a thousand steps × tolerance × ω T give the same",
            );
        }
    }
    Ok(())
}

fn angles_and_quaternions(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let tree = Tree::example();
    let tolerance = 1e-13;
    let job = adaptive(Formula::Dop853, Tolerances::of(tolerance));
    let quaternions = bench.succeed(&tree.scene("tree"), &job)?;
    let mut scene = tree.scene("tree-in-angles");
    scene.text = scene
        .text
        .replace("dimension: 3\n", "dimension: 3\ncoordinates: bryant\n");
    let angles = bench.succeed(&scene, &job)?;
    let changes = angles.header.memory.len();
    bench.at_least(
        "elements whose chart may change",
        changes as f64,
        tree.elements.len() as f64,
        "",
        "all of them",
    );
    bench.at_most(
        "distance of any centre of gravity, over 1 s",
        apart(&quaternions, &angles),
        1e-10,
        "m",
        "the demand; a thousand steps × tolerance × growth give the same",
    );
    Ok(())
}

fn tumbles(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let mut tree = Tree::example();
    tree.gravity = [0.0; 3];
    let tolerance = 1e-9;
    let count = if bench.full() { 1e6 } else { 1e5 };
    for coordinates in ["quaternion", "bryant"] {
        bench.variant(format!("{coordinates}, dopri5 at {tolerance:e}"));
        let mut scene = tree.scene(&format!("tumbling-{coordinates}"));
        let told = format!("dimension: 3\ncoordinates: {coordinates}\n");
        scene.text = scene.text.replace("dimension: 3\n", &told);
        // removes the field, because no force may act
        scene.text = scene
            .text
            .replace(&tree.field("tree"), "")
            .replace("forces:\n", "");
        let job = Job {
            duration: Some(count * 4e-3),
            every: Some(count * 4e-5),
            ..adaptive(Formula::Dopri5, Tolerances::of(tolerance))
        };
        let run = bench.succeed(&scene, &job)?;
        let taken = steps(&run)?;
        bench.at_least(
            "steps",
            taken,
            count,
            "",
            "as many as the name of the case says",
        );
        let energy = run.energy()?;
        // the error of the speed relative to v; and E ~ v² doubles it
        bench.at_most(
            "change of the energy over the energy",
            (energy.end / energy.start - 1.0).abs(),
            2.0 * taken * 2.0 * tolerance,
            "",
            "2 × steps × tolerance × (1 + 1/v), v of a few 1/s",
        );
        bench.at_most(
            "change of momentum and angular momentum over themselves",
            energy.momentum_gap.unwrap_or(f64::NAN),
            taken * 2.0 * tolerance * 10.0,
            "",
            "steps × tolerance × (1 + 1/v), with the lever arm of ten elements",
        );
    }
    Ok(())
}

/// sn, cn, dn of u at the parameter m = k², by the arithmetic-geometric mean (Abramowitz & Stegun 16.4).
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    let mut steps = Vec::new();
    for _ in 0..10 {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
        steps.push(c / a);
        if c.abs() < f64::EPSILON * a {
            break;
        }
    }
    let mut phi = 2f64.powi(steps.len() as i32) * a * u;
    for ratio in steps.iter().rev() {
        phi = 0.5 * (phi + (ratio * phi.sin()).asin());
    }
    let (sin, cos) = phi.sin_cos();
    // 1 − m sn², without a difference of almost equal numbers
    [sin, cos, ((1.0 - m) + m * cos * cos).sqrt()]
}

/// K(m), a quarter of the period of sn.
fn quarter(m: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - m).sqrt());
    while (a - b).abs() > 4.0 * f64::EPSILON * a {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    0.5 * std::f64::consts::PI / a
}

/// Principal moments of inertia of the flipping body.
const MOMENTS: [f64; 3] = [0.01, 0.02, 0.03];

/// ω in the body's axes at time t after the start at (a, 0, b), and the time between two flips.
fn euler(a: f64, b: f64, t: f64) -> ([f64; 3], f64) {
    let [i, j, k] = MOMENTS;
    let energy = i * a * a + k * b * b;
    let momentum = i * i * a * a + k * k * b * b;
    let rate = ((k - j) * (momentum - energy * i) / (i * j * k)).sqrt();
    let m = (j - i) * (energy * k - momentum) / ((k - j) * (momentum - energy * i));
    let [sn, cn, dn] = jacobi(rate * t, m);
    let middle = ((energy * k - momentum) / (j * (k - j))).sqrt();
    // for positive a and b, ω₂ starts at 0 and increases, because (J₃ − J₁) ω₃ ω₁ > 0
    ([a * cn, middle * sn, b * dn], 2.0 * quarter(m) / rate)
}

fn flips(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    // at a = √3 b the motion would be on the separatrix
    let b = 2.0;
    let a = 3f64.sqrt() * b * (1.0 - 1e-3);
    let (_, flip) = euler(a, b, 0.0);
    let flips = 50.0;
    let duration = flips * flip;
    let rest = format!(
        "run: {{ duration: {duration:e} s, every: {:e} s }}\n",
        duration / 1000.0
    );
    let scene = body("dzhanibekov", "quaternion", MOMENTS, [a, 0.0, b], &rest);
    // The growth of an error at the start in ω₁ or ω₃; an error in ω₂ only shifts the motion in time. An error changes
    // the period, and so shifts each further flip by more: it grows linearly with the number of remaining flips, (1 + 2
    // + … + n)/n on average. Errors at the start grow most: the closer the motion is to the middle axis, the less an
    // error changes the period.
    let nudge = 1e-7;
    let growth = largest((0..=1000).flat_map(|i| {
        let t = duration * f64::from(i) / 1000.0;
        let (here, _) = euler(a, b, t);
        let (first, second) = (euler(a + nudge, b, t).0, euler(a, b + nudge, t).0);
        (0..3).map(move |i| (first[i] - here[i]).hypot(second[i] - here[i]) / nudge)
    }));
    let (size, left) = (a.hypot(b), 0.5 * (1.0 + 1.0 / flips));
    for (formula, tolerance) in [
        (Formula::Dopri5, 1e-10),
        (Formula::Dop853, 1e-12),
        (Formula::Rodas5, 1e-9),
    ] {
        bench.variant(name(formula, tolerance));
        let tolerances = Tolerances::of(tolerance);
        let run = bench.succeed(&scene, &adaptive(formula, tolerances))?;
        let mut error: f64 = 0.0;
        let mut turned = 0;
        let mut side: f64 = 1.0;
        for (t, y) in run.times.iter().zip(&run.states) {
            // the state is x, y, z, the quaternion, v, and ω in absolute axes
            let (q, w) = ([y[3], y[4], y[5], y[6]], [y[10], y[11], y[12]]);
            let own = turned_back(q, w);
            let (exact, _) = euler(a, b, *t);
            error = largest(
                [error]
                    .into_iter()
                    .chain((0..3).map(|i| (own[i] - exact[i]).abs())),
            );
            if own[0] * side < -0.5 * a {
                turned += 1;
                side = -side;
            }
        }
        bench.at_least(
            "flips",
            f64::from(turned),
            49.0,
            "",
            "50 times their period; the last one may just begin",
        );
        bench.at_most(
            "error of ω in the body's axes",
            error,
            steps(&run)? * of_a_step(&tolerances, size) * left * growth,
            "rad/s",
            format!(
                "steps × (r ω + √3 a_ω + 4 ω a_θ) × half the growth of an error of the start, {growth:.0}, by the closed form: it is linear in \
                 the flips left"
            ),
        );
    }
    Ok(())
}

/// Bound of the change of ω in the body's axes in a step: errors of three components of ω, and errors a_θ of four
/// numbers of the quaternion, 2 a_θ in total, which are a rotation by 4 a_θ.
fn of_a_step(of: &Tolerances, rate: f64) -> f64 {
    of.relative * rate + 3f64.sqrt() * of.angular_velocities + 4.0 * rate * of.angles
}

/// Converts a vector in absolute axes to the axes of a body: Aᵀ v.
fn turned_back([w, x, y, z]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let rows = [
        [
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
        ],
        [
            2.0 * (x * y + w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z - w * x),
        ],
        [
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            1.0 - 2.0 * (x * x + y * y),
        ],
    ];
    [0, 1, 2].map(|j| (0..3).map(|i| rows[i][j] * v[i]).sum())
}

fn spins(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let (across, along) = (1e-3, 2e-3);
    let (wobble, spin) = (500.0, 1e4);
    let duration = 0.1;
    let rest = "outputs:
  - { name: px, of: top/body, at: [0, 0, 1], what: position, component: x }
  - { name: py, of: top/body, at: [0, 0, 1], what: position, component: y }
  - { name: pz, of: top/body, at: [0, 0, 1], what: position, component: z }
run: { duration: 0.1 s, every: 1 ms }
";
    // L = (J₁ ω₁, 0, J₃ ω₃) is inclined to the axis of the top, which is z at the start
    let momentum: [f64; 2] = [across * wobble, along * spin];
    let size = momentum[0].hypot(momentum[1]);
    let [sin, cos] = momentum.map(|l| l / size);
    let rate = size / across;
    let exact = |t: f64| {
        // z rotated about L by the angle L/J₁ t: its part along L stays, the rest rotates
        let (s, c) = (rate * t).sin_cos();
        let beside = [-sin * cos, 0.0, sin * sin];
        let third = [0.0, -sin, 0.0];
        let along = [sin * cos, 0.0, cos * cos];
        [0, 1, 2].map(|i| along[i] + c * beside[i] + s * third[i])
    };
    for coordinates in ["quaternion", "bryant"] {
        let scene = body(
            &format!("spin-{coordinates}"),
            coordinates,
            [across, across, along],
            [wobble, 0.0, spin],
            rest,
        );
        for (formula, tolerance) in [(Formula::Dopri5, 1e-9), (Formula::Dop853, 1e-12)] {
            bench.variant(format!("{coordinates}, {}", name(formula, tolerance)));
            let tolerances = Tolerances::of(tolerance);
            let run = bench.succeed(&scene, &adaptive(formula, tolerances))?;
            // errors of angles or quaternions, and of three rates, of which at most one is faster than the wobble
            let turned = 4.0 * tolerances.angles;
            let rates = spin + 2.0 * wobble;
            let rate_error = tolerances.relative * rates + 3.0 * tolerances.angular_velocities;
            let momentum_error = rate_error / spin + 2.0 * turned;
            let [x, y, z] = point(&run)?;
            let errors = run.times.iter().enumerate().map(|(i, t)| {
                let exact = exact(*t);
                largest([x[i] - exact[0], y[i] - exact[1], z[i] - 0.1 - exact[2]].map(f64::abs))
            });
            bench.at_most(
                "error of the axis",
                largest(errors),
                steps(&run)? * (turned + momentum_error * (2.0 + 0.5 * sin * rate * duration)),
                "",
                "steps × (δθ + δL/L (2 + sin α · L/J₁ · T/2)): a step rotates the body by δθ ≤ 4 a_θ and L by δL/L ≤ δω/ω + 2 \
                 δθ; the axis continues about the rotated L, too fast or too slow by δL/J₁ for half of T on average, on a cone \
                 of the half angle α",
            );
        }
    }
    Ok(())
}

fn stays_a_unit(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let rest = "run: { duration: 1 s, every: 1 s }\n";
    let scene = body(
        "unit",
        "quaternion",
        [0.03, 0.04, 0.02],
        [3.0, -2.0, 5.0],
        rest,
    );
    for (formula, step) in [(Formula::Rk4, 1e-3), (Formula::Dopri5, 1e-3)] {
        bench.variant(format!("{}, 1e6 steps of {step} s", formula.name()));
        let job = many(formula, step, 1e6, 100.0);
        let run = bench.succeed(&scene, &job)?;
        let norms = run.states.iter().map(|y| {
            let square: f64 = y[3..7].iter().map(|q| q * q).sum();
            (square.sqrt() - 1.0).abs()
        });
        bench.at_most(
            "deviation of the length from 1",
            largest(norms),
            4.0 * f64::EPSILON,
            "",
            "four products, their sum, a root and a division round once each",
        );
    }
    Ok(())
}

fn chart_in_contact(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let rest = "forces:
  - { field: gravity, acceleration: [0, 0, -9.81 m/s^2] }
  - contact: floor
    ellipsoid: { on: top/body, center: [0, 0, 0], semi_axes: [0.1, 0.09, 0.11] }
    plane: { on: frame, at: [0, 0, 0.01], normal: [0, 0, 1] }
    elastic: { points: [[0, 0], [1, 2e3]], extrapolate: linear }
    friction: 0.1
    friction_speed: 1 m/s
outputs:
  - { name: px, of: top/body, at: [0.1, 0.2, 0.3], what: position, component: x }
  - { name: py, of: top/body, at: [0.1, 0.2, 0.3], what: position, component: y }
  - { name: pz, of: top/body, at: [0.1, 0.2, 0.3], what: position, component: z }
  - { name: force, of: contact floor, what: force }
run: { duration: 1 s, every: 5 ms }
";
    let tolerances = Tolerances::of(1e-12);
    let job = with_kinks(Formula::Dop853, tolerances, true);
    let of = |coordinates: &str| {
        let name = format!("rolling-{coordinates}");
        body(
            &name,
            coordinates,
            [0.004, 0.0045, 0.0038],
            [1.0, 12.0, 0.5],
            rest,
        )
    };
    let quaternions = bench.succeed(&of("quaternion"), &job)?;
    let angles = bench.succeed(&of("bryant"), &job)?;
    // sin φ₂ = 2 (x z + w y) exceeds 0.9 while the floor pushes
    let force = quaternions.output("force")?;
    let pressed = quaternions.states.iter().zip(&force).filter(|(y, force)| {
        let sine: f64 = 2.0 * (y[4] * y[6] + y[3] * y[5]);
        sine.abs() > 0.9 && **force > 0.1
    });
    bench.at_least(
        "samples near a pole and in contact",
        pressed.count() as f64,
        3.0,
        "",
        "the chart changes there",
    );
    // In contact, height and speed oscillate with √(k/m); without contact, an error of speed acts for the whole run.
    let (omega, rate, duration) = (2e3f64.sqrt(), 12.0, 1.0);
    let count = steps(&quaternions)? + steps(&angles)?;
    let turning = of_a_step(&tolerances, rate) + omega * 4.0 * tolerances.angles;
    let moving = error_of_speed(&tolerances, rate * LONGEST, omega);
    let error = count * (turning * LONGEST + moving) * (1.0 / omega + duration);
    bench.at_most(
        "difference of any output, over 1 s",
        apart(&quaternions, &angles),
        error * 2e3,
        "m, N",
        "steps of both × (r v + a_v + √(k/m) a_x, of turning and of moving) × (1/√(k/m) + T): an error of speed causes a \
         displacement that is at most linear in time; for a force, times k",
    );
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elliptic_functions_keep_their_identities() {
        for m in [0.1, 0.5, 0.99] {
            for u in [0.1, 0.7, 2.0] {
                let [sn, cn, dn] = jacobi(u, m);
                assert!((sn * sn + cn * cn - 1.0).abs() < 1e-14);
                assert!((dn * dn + m * sn * sn - 1.0).abs() < 1e-13, "{u} {m}");
            }
            let [sn, ..] = jacobi(quarter(m), m);
            assert!((sn - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn the_motion_keeps_energy_and_momentum_and_obeys_euler() {
        let (a, b, h) = (3.4, 2.0, 1e-5);
        let [i, j, k] = MOMENTS;
        for t in [0.0, 0.3, 1.7] {
            let at = |t: f64| euler(a, b, t).0;
            let w = at(t);
            let rate = [0, 1, 2].map(|n| (at(t + h)[n] - at(t - h)[n]) / (2.0 * h));
            let expected = [
                (j - k) / i * w[1] * w[2],
                (k - i) / j * w[2] * w[0],
                (i - j) / k * w[0] * w[1],
            ];
            for n in 0..3 {
                // a difference quotient errs by h² and by ε/h
                assert!(
                    (rate[n] - expected[n]).abs() < 1e-7,
                    "{t}: {rate:?} {expected:?}"
                );
            }
        }
    }
}
