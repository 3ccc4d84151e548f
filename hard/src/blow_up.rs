//! Runs that cannot be trusted must say so, with the time and the reason; runs that can be trusted must not.

use crate::bench::{Bench, Run, Trouble};
use crate::case::{Case, Group};
use crate::jobs::fixed;
use crate::{CaseModel, scene};
use bryant_runtime::Formula;
use bryant_runtime::program::Job;

/// The cases of this group.
pub const CASES: &[Case] = &[
    Case {
        group: Group::BlowUp,
        name: "fixed steps above the limit of stability",
        law: "On ẏ = λ y with λ < 0 a method is stable for h |λ| below its limit, where |R(−h |λ|)| = 1. Above the limit the run is \
              reported as not to be trusted, with the limit.",
        run: steps_above_the_limit,
    },
    Case {
        group: Group::BlowUp,
        name: "energy out of nothing",
        law: "Heun's method multiplies the energy of ẍ = −x by 1 + h⁴/4 in each step. So 2 % are missing in the balance after 2 % · 4/h⁴ \
              steps.",
        run: energy_out_of_nothing,
    },
    Case {
        group: Group::BlowUp,
        name: "curves left behind",
        law: "A run cannot be trusted if a curve is followed beyond its points by more than its own width, or if its value is held without \
              `extrapolate: hold`. With `extrapolate: hold`, and for a line through 0, it can. A curve with `extrapolate: error` ends the \
              run when it is left.",
        run: curves_left_behind,
    },
    Case {
        group: Group::BlowUp,
        name: "inertia that vanishes in motion",
        law: "Two links without inertia of their own have det S = m² a² b² sin² θ. When they come into line, the accelerations are not \
              determined.",
        run: inertia_that_vanishes,
    },
    Case {
        group: Group::BlowUp,
        name: "no false alarm",
        law: "Scenes with right results, among them the hardest ones here, are not reported as doubtful.",
        run: no_false_alarm,
    },
];

/// The first x with |R(−x)| = 1, where R is the polynomial with these coefficients of 1, z, z² …
fn real_limit(coefficients: &[f64]) -> f64 {
    let inside = |x: f64| {
        let value = coefficients.iter().rev().fold(0.0, |sum, c| sum * -x + c);
        value.abs() <= 1.0
    };
    // the limit of each polynomial is between 1 and 10, with |R| ≤ 1 everywhere below it
    let (mut low, mut high) = (1.0, 10.0);
    while inside(low + 1e-3) && low < 10.0 {
        low += 1e-3;
    }
    high = f64::min(high, low + 2e-3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match inside(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    low
}

/// Stability polynomials (Hairer & Wanner II, IV.2; for Merson's method: Hairer, Nørsett & Wanner I, II.4).
const POLYNOMIALS: [(Formula, &[f64]); 4] = [
    (Formula::Heun, &[1.0, 1.0, 0.5]),
    (Formula::Rk4, &[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0]),
    (
        Formula::Merson,
        &[1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 144.0],
    ),
    (
        Formula::Dopri5,
        &[
            1.0,
            1.0,
            0.5,
            1.0 / 6.0,
            1.0 / 24.0,
            1.0 / 120.0,
            1.0 / 600.0,
        ],
    ),
];

/// The messages of a run: its failure, else its doubts.
fn said(run: &Run) -> String {
    match &run.result {
        Err(error) => format!("failed: {}", error.message),
        Ok(_) if run.doubts.is_empty() => "nothing".to_owned(),
        Ok(_) => {
            let doubts = run.doubts.iter().map(|doubt| doubt.message.as_str());
            doubts.collect::<Vec<_>>().join("; ")
        }
    }
}

fn steps_above_the_limit(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("stiff-oscillator");
    let rate = (1e6f64 / 1e-3).sqrt();
    for (formula, polynomial) in POLYNOMIALS {
        let limit = real_limit(polynomial) / rate;
        bench.variant(formula.name());
        let below = bench.run(&scene, &fixed(formula, 0.9 * limit))?;
        // the energy error of the first swing with such a large step does not matter here
        bench.states(
            "0.9 of the limit: not doubted because of the step",
            below.result.is_ok() && below.doubts.iter().all(|doubt| doubt.kind != "step"),
            said(&below),
            "stable",
        );
        let above = bench.run(&scene, &fixed(formula, 1.2 * limit))?;
        let of_step = above.doubts.iter().find(|doubt| doubt.kind == "step");
        bench.states(
            "1.2 of the limit: doubted because of the step",
            of_step.is_some(),
            said(&above),
            "unstable",
        );
        if let Some(doubt) = of_step {
            // ratio of the step to the largest stable one along the direction in which the stable region reaches
            // farthest
            let largest = formula.stability_limit().unwrap_or(f64::NAN) / rate;
            let found = 1.2 * limit / doubt.amount;
            bench.at_most(
                "deviation of the limit in the message from the method's limit over ω",
                (found / largest - 1.0).abs(),
                2.0 / 15.0,
                "",
                "λ is a double root, so λᵏ k also grows, by 1/k for each step in coordinates and in velocities: the message comes after k = 15 steps",
            );
        }
    }
    Ok(())
}

fn energy_out_of_nothing(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene: CaseModel = scene!("oscillator");
    for h in [0.5, 0.2, 0.1f64] {
        bench.variant(format!("h = {h}"));
        // a whole number of steps between samples
        let job = Job {
            duration: Some(8.0 * 0.02 * 4.0 / h.powi(3)),
            every: Some(h),
            ..fixed(Formula::Heun, h)
        };
        let run = bench.run(&scene, &job)?;
        let doubt = run.doubts.iter().find(|doubt| doubt.kind == "energy");
        bench.states(
            "doubted because of the energy",
            doubt.is_some(),
            said(&run),
            "2 % are exceeded",
        );
        if let Some(doubt) = doubt {
            let growth = (h.powi(4) / 4.0).ln_1p();
            // a doubt begins when E − E₀ exceeds 2 % of E; twice in a period all energy is kinetic, or all is in the
            // spring
            let expected = -(0.98f64).ln() / growth * h;
            let pi = std::f64::consts::PI;
            bench.at_least(
                "since when",
                doubt.since,
                0.5 * expected - h,
                "s",
                "half of 2 % · 4/h³: at any time at least half of the energy is kinetic or work",
            );
            bench.at_most(
                "since when",
                doubt.since,
                2.0 * expected + pi,
                "s",
                "twice that, and half a period",
            );
        }
    }
    Ok(())
}

fn curves_left_behind(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let run = bench.run(&scene!("left-curves"), &Job::default())?;
    for (name, since) in [
        // doubts begin at more than the width of the curve beyond its end: 0.1 + 0.1 rad at 1 rad/s
        ("line", Some(0.2)),
        ("held", Some(0.1)),
        ("told", None),
        ("straight", None),
    ] {
        bench.variant(name);
        let doubt = run.doubts.iter().find(|doubt| {
            doubt.kind == "curve" && doubt.message.contains(&format!("{name}/wheel"))
        });
        bench.states(
            match since {
                Some(_) => "doubted",
                None => "not doubted",
            },
            doubt.is_some() == since.is_some(),
            said(&run),
            "docs/reference.md, when a run cannot be trusted",
        );
        if let (Some(doubt), Some(since)) = (doubt, since) {
            let longest = run.report()?.largest_step;
            bench.at_most(
                "deviation of its time from when the wheel comes there",
                (doubt.since - since).abs(),
                longest,
                "s",
                "a run is watched at the ends of steps",
            );
        }
    }
    bench.variant("must not be left");
    let run = bench.run(&scene!("ended-curve"), &Job::default())?;
    let message = said(&run);
    bench.states(
        "the run fails, and names the curve",
        run.result.is_err() && message.contains("arm/wheel"),
        message,
        "`extrapolate: error`",
    );
    if let Err(error) = &run.result {
        bench.at_most(
            "deviation of the time from when the wheel comes there",
            (error.t.unwrap_or(f64::NAN) - 0.1).abs(),
            0.01,
            "s",
            "the time between samples",
        );
    }
    Ok(())
}

fn inertia_that_vanishes(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scene = scene!("no-inertia");
    for (variant, fold) in [("from there on", 0.0), ("driven there", 0.05)] {
        bench.variant(variant);
        let job = Job {
            parameters: vec![("fold".into(), fold)],
            ..Job::default()
        };
        let run = bench.run(&scene, &job)?;
        let message = said(&run);
        let named = message.contains("arm/upper") && message.contains("vanishes");
        bench.states(
            "the run ends, with time and element",
            run.result.is_err() && named,
            message,
            "S is singular there",
        );
    }
    Ok(())
}

fn no_false_alarm(bench: &mut Bench<'_>) -> Result<(), Trouble> {
    let scenes = [
        scene!("ball-to-rest"),
        scene!("buried"),
        scene!("ceiling"),
        scene!("corner"),
        scene!("crate-at-rest"),
        scene!("hard-ball"),
        scene!("incline"),
        scene!("pressed-stop"),
        scene!("rebound-stop"),
        scene!("snapping-belt"),
        scene!("ten-feet"),
    ];
    for scene in scenes {
        bench.variant(scene.name.clone());
        let run = bench.succeed(&scene, &Job::default())?;
        bench.states(
            "not doubted",
            run.doubts.is_empty(),
            said(&run),
            "its results are correct",
        );
    }
    Ok(())
}
