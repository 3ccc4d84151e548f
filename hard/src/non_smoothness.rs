//! Friction that holds, contacts that close and open.
//!
//! As in stiff scenes, N steps with error control change a speed v by at most N · tolerance · (1 + v) · ω, with the
//! frequency ω of the stiffest spring that acts. If a motion is damped and comes to rest, earlier errors decay, and the
//! tolerance of a few steps remains.

use crate::bench::{Bench, Run, Trouble};
use crate::case::{Case, Group};
use crate::jobs::{many, name, name_with_kinks, with_kinks};
use crate::measure::{largest, steps};
use crate::{CaseModel, scene};
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Tolerances};

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::NonSmoothness,
        name: "a block that sticks on a slope for 100 s",
        law: "With friction that holds, the bristles are deflected by z_b tan α/μ, and then nothing moves any more \
              (docs/forces/friction.md). With friction by speed the block creeps with exactly v_s tan α/μ.",
        run: sticks,
    },
    Case {
        group: Group::NonSmoothness,
        name: "joints that friction holds for 20 s",
        law: "The force Q is below the friction M of the joint. With friction that holds, the bristles are deflected by z_b Q/M, and then \
              nothing moves any more (docs/forces/joint.md). With friction by speed the joint creeps with exactly v Q/M.",
        run: brakes,
    },
    Case {
        group: Group::NonSmoothness,
        name: "a sliding block stops without chatter",
        law: "By Coulomb's law the block stops after v²/(2 μ g). It springs back by less than the deflection of the bristles, and lies \
              still.",
        run: stops,
    },
    Case {
        group: Group::NonSmoothness,
        name: "grazing contact",
        law: "A ball is thrown at a ceiling and misses it, just touches it, or penetrates it by a nanometre. It moves along a parabola, in \
              half an oscillation while it touches, and along a parabola again.",
        run: grazes,
    },
    Case {
        group: Group::NonSmoothness,
        name: "bouncing until rest",
        law: "The bounces get lower and follow each other faster and faster. The ball comes to rest at the depth m g/k, after a finite \
              number of steps.",
        run: bounces_until_rest,
    },
    Case {
        group: Group::NonSmoothness,
        name: "ten contacts at once",
        law: "Ten feet that touch at the same instant carry like one foot of ten times the stiffness, and nothing turns.",
        run: ten_contacts,
    },
    Case {
        group: Group::NonSmoothness,
        name: "a box at rest for a million steps",
        law: "Nothing moves. The only kinetic energy comes from rounding.",
        run: box_at_rest,
    },
    Case {
        group: Group::NonSmoothness,
        name: "over the corner of a plane that ends",
        law: "The force fades towards the edges, and the edges push outwards by as much as the stored energy falls \
              (docs/forces/contact.md). So the kinetic energy before and after is the same.",
        run: over_the_corner,
    },
    Case {
        group: Group::NonSmoothness,
        name: "initial penetration",
        law: "The ball starts at rest at the depth δ. It leaves after a quarter of an oscillation with the speed δ √(k/m).",
        run: buried,
    },
];

/// The coefficient of friction, and the thresholds of the two friction laws (`scenes/incline.yaml`): a deflection of
/// bristles \[m\] and a speed \[m/s\].
const MU: f64 = 0.4;
const BRISTLE: f64 = 1e-4;
const CREEP: f64 = 1e-2;

/// Downhill displacement of a block at every sample.
fn way(run: &Run, block: &str, slope: f64) -> Result<Vec<f64>, Trouble> {
    let (sin, cos) = slope.sin_cos();
    let x = run.state(&format!("{block}.x"))?;
    let z = run.state(&format!("{block}.z"))?;
    Ok(x.iter().zip(z).map(|(x, z)| x * cos - z * sin).collect())
}

fn sticks(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("incline");
    let tolerance = 1e-7;
    let limit = Tolerances::of(tolerance);
    for (formula, degrees) in [
        (Formula::Dopri5, 15.0),
        // it slides above atan 0.4 = 21.8°
        (Formula::Dopri5, 21.5),
        (Formula::Rodas5, 15.0),
        (Formula::Rodas5, 21.5),
    ] {
        bench.variant(format!("{}, {degrees}°", name(formula, tolerance)));
        let slope = f64::to_radians(degrees);
        let job = Job {
            parameters: vec![("slope".into(), slope)],
            ..with_kinks(formula, limit, false)
        };
        let run = bench.succeed(&scene, &job)?;
        let rounding = steps(&run)? * f64::EPSILON;
        let [first, last] = [1, 100];
        let held = way(&run, "holds", slope)?;
        bench.at_most(
            "creep from 1 s to 100 s",
            (held[last] - held[first]).abs(),
            10.0 * limit.positions + rounding,
            "m",
            "every step keeps x − z except for rounding, and the deflection z is at rest: ten steps' tolerance, steps × ε",
        );
        let deflection = run.header.auxiliaries.first().cloned().unwrap_or_default();
        let deflection = run.state(&deflection)?[last].abs();
        bench.at_most(
            "deviation of the bristles' deflection from z_b tan α/μ",
            (deflection - BRISTLE * slope.tan() / MU).abs(),
            10.0 * limit.positions + rounding,
            "m",
            "ten steps' tolerance, steps × ε",
        );
        let crept = way(&run, "creeps", slope)?;
        let speed = CREEP * slope.tan() / MU;
        let duration = run.times[last] - run.times[first];
        bench.at_most(
            "friction by speed: deviation of the creep from v_s tan α/μ",
            ((crept[last] - crept[first]) / duration - speed).abs(),
            10.0 * tolerance * (1.0 + speed),
            "m/s",
            "ten steps' tolerance",
        );
    }
    Ok(())
}

fn brakes(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("brakes");
    let tolerance = 1e-7;
    let limit = Tolerances::of(tolerance);
    // Q/M of cage and arm, from `scenes/brakes.yaml`
    let (cage, arm) = (2.0 * 9.81 / 20.0, 2.0 * 9.81 * 0.5 / 12.0);
    for formula in [Formula::Dopri5, Formula::Rodas5] {
        bench.variant(name(formula, tolerance));
        let run = bench.succeed(&scene, &with_kinks(formula, limit, false))?;
        let rounding = steps(&run)? * f64::EPSILON;
        let [first, last] = [1, 20];
        for (joint, coordinate, share) in [
            ("holds/cage", "holds/cage.position", cage),
            ("crane/arm", "crane/arm.angle", arm),
        ] {
            let held = run.state(coordinate)?;
            bench.at_most(
                format!("{joint}: creep from 1 s to 20 s"),
                (held[last] - held[first]).abs(),
                10.0 * limit.positions + rounding,
                "m or rad",
                "every step keeps θ − z except for rounding, and the deflection z is at rest: ten steps' tolerance, steps × ε",
            );
            let bristle = run.state(&format!("joint {joint}: bristle"))?[last];
            bench.at_most(
                format!("{joint}: deviation of the bristles' deflection from z_b Q/M"),
                (bristle.abs() - BRISTLE * share).abs(),
                10.0 * limit.positions + rounding + BRISTLE * held[last].powi(2),
                "m or rad",
                "ten steps' tolerance, steps × ε, and the effect of the arm's rotation on its torque",
            );
        }
        let crept = run.state("creeps/cage.position")?;
        let duration = run.times[last] - run.times[first];
        let speed = CREEP * cage;
        bench.at_most(
            "friction by speed: deviation of the creep from v Q/M",
            ((crept[last] - crept[first]) / duration - speed).abs(),
            10.0 * tolerance * (1.0 + speed),
            "m/s",
            "ten steps' tolerance",
        );
    }
    Ok(())
}

fn stops(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("incline");
    let tolerance = 1e-7;
    let limit = Tolerances::of(tolerance);
    for formula in [Formula::Dopri5, Formula::Tsit5, Formula::Rodas5] {
        bench.variant(name(formula, tolerance));
        let speed = 2.0;
        let job = Job {
            parameters: vec![("slope".into(), 0.0), ("speed".into(), speed)],
            duration: Some(2.0),
            every: Some(1e-3),
            ..with_kinks(formula, limit, false)
        };
        let run = bench.succeed(&scene, &job)?;
        let x = run.state("holds.x")?;
        let v = run.state("holds.vx")?;
        let end = x[x.len() - 1];
        bench.at_most(
            "deviation of the stopping distance from v²/(2 μ g)",
            (end - x[0] - speed * speed / (2.0 * MU * 9.81)).abs(),
            2.0 * BRISTLE,
            "m",
            "z_b while the bristles bend, and z_b while they spring back",
        );
        bench.at_most(
            "way back",
            largest(x.iter().map(|x| x - end)),
            BRISTLE,
            "m",
            "the deflection of the bristles",
        );
        // ζ = c/(2 √(k m)) of the bristles, with k = μ N/z_b and c = μ N/v_s
        let damping = 0.5 / CREEP * (MU * 9.81 * BRISTLE).sqrt();
        bench.at_least(
            "damping of the bristles over critical damping",
            damping,
            0.9,
            "",
            "so that they swing back only once",
        );
        let still = 10.0 * tolerance;
        let turns = v
            .windows(2)
            .filter(|v| v[0].max(v[1]) > still && v[0].min(v[1]) < -still);
        bench.at_most(
            "changes of direction",
            turns.count() as f64,
            2.0,
            "",
            "it springs back once and then rests",
        );
        bench.at_most(
            "way in the last half second",
            (end - x[x.len() - 501]).abs(),
            10.0 * limit.positions + steps(&run)? * f64::EPSILON,
            "m",
            "ten steps' tolerance, steps × ε",
        );
    }
    Ok(())
}

fn grazes(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("ceiling");
    let (gravity, speed, stiffness): (f64, f64, f64) = (10.0, 5.0, 1e7);
    let omega = stiffness.sqrt();
    let tolerance = 1e-11;
    for (formula, locate) in [(Formula::Dopri5, false), (Formula::Dop853, true)] {
        for excess in [-1e-3, -1e-9, 0.0, 1e-9, 1e-6, 1e-3] {
            bench.variant(format!(
                "{}, {excess:e} m too high",
                name_with_kinks(formula, tolerance, locate)
            ));
            let job = Job {
                parameters: vec![("excess".into(), excess)],
                ..with_kinks(formula, Tolerances::uniform(tolerance), locate)
            };
            let run = bench.succeed(&scene, &job)?;
            // Without the ceiling the ball would be above it for 2 v₀/g; with the ceiling, δ'' = −g − ω² δ returns it
            // sooner.
            let ahead = |excess: f64| {
                let entry = (2.0 * gravity * excess.max(0.0)).sqrt();
                2.0 * entry / gravity - 2.0 / omega * (entry * omega / gravity).atan()
            };
            let t = 1.0 + ahead(excess);
            let exact = excess + speed * t - 0.5 * gravity * t * t;
            let z = run.state("ball.z")?;
            let found = z[z.len() - 1];
            let contact = if excess > 0.0 { omega } else { 1.0 };
            let error = steps(&run)? * tolerance * (1.0 + speed) * contact;
            // an error of the height changes the speed of entry, and so the time above the ceiling
            let height = error / contact * (1.0 + speed / gravity);
            let shift =
                [excess - height, excess + height].map(|e| (ahead(e) - ahead(excess)).abs());
            bench.at_most(
                "error of the height after 1 s",
                (found - exact).abs(),
                2.0 * error + speed * largest(shift),
                "m",
                "steps × tolerance × (1 + v), times ω during contact, and the effect of an error of the height at touch on the time above",
            );
        }
    }
    Ok(())
}

fn bounces_until_rest(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("ball-to-rest");
    let depth = 10.0 / 1e6;
    for (formula, tolerance, locate) in [
        (Formula::Dopri5, 1e-3, false),
        (Formula::Dopri5, 1e-7, false),
        (Formula::Dopri5, 1e-7, true),
        (Formula::Dop853, 1e-10, true),
        (Formula::Rodas5, 1e-7, false),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let limit = Tolerances::of(tolerance);
        let run = bench.succeed(&scene, &with_kinks(formula, limit, locate))?;
        let last = run.last()?;
        // frequency of the ball on the plate
        let omega = 1e3;
        bench.at_most(
            "distance from the position of rest",
            (last[1] - 0.1 + depth).abs(),
            10.0 * (limit.positions + tolerance / omega),
            "m",
            "ten steps' tolerance, of the height and of the speed over ω",
        );
        bench.at_most(
            "speed",
            last[4].abs(),
            10.0 * (tolerance + limit.positions * omega),
            "m/s",
            "ten steps' tolerance, of the speed and of the height times ω",
        );
    }
    Ok(())
}

fn ten_contacts(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let tolerance = 1e-9;
    // √(k/m) of all feet together
    let omega = (1e6f64 / 10.0).sqrt();
    for (formula, locate) in [
        (Formula::Dopri5, false),
        (Formula::Dopri5, true),
        (Formula::Rodas5, false),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let job = with_kinks(formula, Tolerances::uniform(tolerance), locate);
        let ten = bench.succeed(&scene!("ten-feet"), &job)?;
        let one = bench.succeed(&scene!("one-foot"), &job)?;
        let error = (steps(&ten)? + steps(&one)?) * tolerance * (1.0 + 2.0);
        let (a, b) = (ten.state("beam.z")?, one.state("beam.z")?);
        let away = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
        bench.at_most(
            "ten feet against one",
            largest(away),
            2.0 * error * omega,
            "m",
            "steps of both × tolerance × (1 + v) ω, for 2 s",
        );
        let angles = ten.state("beam/body.phi")?.into_iter().map(f64::abs);
        // Feet at ±x carry equal loads up to rounding: moments of ε k δ x tilt the beam, and the feet resist.
        let moment = f64::EPSILON * 1e6 * 0.02;
        let stiffness: f64 = (0..10)
            .map(|i| 1e5 * (0.2 * f64::from(i) - 0.9).powi(2))
            .sum();
        bench.at_most(
            "tilt",
            largest(angles),
            steps(&ten)? * moment / stiffness,
            "rad",
            "the moment of rounded forces over the stiffness against tilting, once for each step",
        );
    }
    Ok(())
}

fn box_at_rest(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("crate-at-rest");
    let count: f64 = if bench.full() { 1e7 } else { 1e6 };
    let (mass, gravity, height, omega) = (2.0, 9.81, 0.11, (2e5f64 / 2.0).sqrt());
    let step = 1e-4;
    for formula in [Formula::Rk4, Formula::SemiImplicitEuler] {
        bench.variant(format!("{}, {count:e} steps of {step} s", formula.name()));
        let job = many(formula, step, count, 100.0);
        let run = bench.succeed(&scene, &job)?;
        let speed = count * f64::EPSILON * (gravity * step + omega * height);
        let energy = run
            .states
            .iter()
            .map(|y| 0.5 * (mass * (y[3] * y[3] + y[4] * y[4]) + 0.033 * y[5] * y[5]));
        bench.at_most(
            "kinetic energy at any sample",
            largest(energy),
            0.5 * mass * speed * speed,
            "J",
            "m v²/2 of v = steps × ε (g h + ω z): each step rounds a velocity by ε g h and a height by ε z",
        );
    }
    Ok(())
}

fn over_the_corner(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene: CaseModel = scene!("corner");
    let omega = (1e5f64 / 2.0).sqrt();
    for (formula, tolerance, locate) in [
        (Formula::Dopri5, 1e-8, false),
        (Formula::Dop853, 1e-11, true),
        (Formula::Rodas5, 1e-8, false),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let job = with_kinks(formula, Tolerances::uniform(tolerance), locate);
        let run = bench.succeed(&scene, &job)?;
        let force = run.output("force")?;
        let (first, last) = (force[0], force[force.len() - 1]);
        let most = largest(force.iter().copied());
        bench.states(
            "it comes without touching, touches, and leaves",
            first == 0.0 && last == 0.0 && most > 10.0,
            format!("{first:.0} N, at most {most:.0} N, {last:.0} N"),
            "at both ends all energy is kinetic",
        );
        let energy = run.energy()?;
        let speed = steps(&run)? * tolerance * (1.0 + 3.0) * omega;
        // T = ½ v·M v changes by M v·δv; the momentum is that of 2 kg at 1 m/s, and rotation adds as much
        bench.at_most(
            "change of the kinetic energy",
            (energy.end - energy.start).abs(),
            4.0 * speed,
            "J",
            "momentum × steps × tolerance × (1 + v) ω",
        );
        bench.at_most(
            "change of the momentum over that exchanged",
            energy.momentum_gap.unwrap_or(f64::NAN),
            steps(&run)? * tolerance * (1.0 + 3.0) * omega,
            "",
            "as the speed",
        );
    }
    Ok(())
}

fn buried(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("buried");
    let (depth, omega): (f64, f64) = (0.05, 1e3);
    let leaves = 0.5 * std::f64::consts::PI / omega;
    let exact = |t: f64| match t < leaves {
        true => 0.1 - depth * (omega * t).cos(),
        false => 0.1 + depth * omega * (t - leaves),
    };
    for (formula, tolerance, locate) in [
        (Formula::Dopri5, 1e-8, false),
        (Formula::Dop853, 1e-12, true),
        (Formula::Rodas5, 1e-8, false),
    ] {
        bench.variant(name_with_kinks(formula, tolerance, locate));
        let run = bench.succeed(
            &scene,
            &with_kinks(formula, Tolerances::uniform(tolerance), locate),
        )?;
        let speed = steps(&run)? * tolerance * (1.0 + depth * omega) * omega;
        let heights = run.state("ball.z")?.into_iter().zip(&run.times);
        let away = heights.map(|(z, t)| (z - exact(*t)).abs());
        bench.at_most(
            "error of the height",
            largest(away),
            speed * 5e-3,
            "m",
            "steps × tolerance × (1 + v) ω, for 5 ms",
        );
    }
    Ok(())
}
