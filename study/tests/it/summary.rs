//! Summaries compared with closed forms.

use crate::common::{Closed, Formula, ishigami, open, study, with};
use bryant_picture::Format;
use bryant_study::report::report;
use bryant_study::results::Results;
use bryant_study::run::run;
use bryant_study::shard::Shard;
use bryant_study::study::Study;
use bryant_study::summary::index::{Estimate, Estimator, Sensitivity};
use bryant_study::summary::{About, summarize};
use std::f64::consts::PI;

/// The numbers about both responses.
fn about(study: &Study, formula: Formula) -> Vec<About> {
    let directory = tempfile::tempdir().unwrap();
    let folder = open(directory.path(), study);
    run(study, &Closed(formula), &folder, Shard::WHOLE, 2, &|_| {}).unwrap();
    let results = Results::new(study, &folder, None).unwrap();
    summarize(&results).unwrap().0.responses
}

/// Main and total indices of each parameter.
type Exact = [[f64; 2]; 3];

/// The indices of sin a + 7 sin² b + c⁴ sin a / 10 \[Ishigami and Homma, 1990\].
fn exact_ishigami() -> Exact {
    let (a, b) = (7.0, 0.1);
    let first = 0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2);
    let second = a * a / 8.0;
    let both = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let variance = first + second + both;
    [[first, first + both], [second, second], [0.0, both]].map(|pair| pair.map(|v| v / variance))
}

/// Coefficients of the g-function.
const G: [f64; 3] = [0.0, 1.0, 4.5];

/// Sobol's g-function, Π (|4 u − 2| + a)/(1 + a), with u = (x + π)/2π; and a polynomial.
fn sobol_g(x: &[f64]) -> Vec<f64> {
    let u = x.iter().map(|x| (x + PI) / (2.0 * PI));
    let g = u
        .zip(G)
        .map(|(u, a)| ((4.0 * u - 2.0).abs() + a) / (1.0 + a))
        .product();
    vec![g, 2.0 * x[0] + x[1] * x[2]]
}

/// V_i = 1/3(1 + a_i)², V = Π (1 + V_i) − 1.
fn exact_g() -> Exact {
    let one = G.map(|a| 1.0 / (3.0 * (1.0 + a) * (1.0 + a)));
    let all: f64 = one.iter().map(|v| 1.0 + v).product();
    one.map(|v| [v / (all - 1.0), v * all / (1.0 + v) / (all - 1.0)])
}

fn estimates(of: &Sensitivity) -> Vec<[Estimate; 2]> {
    of.parameters.iter().map(|p| [p.main, p.total]).collect()
}

#[test]
fn groups_find_the_indices_of_closed_forms() {
    let groups = 4096.0;
    for (formula, exact) in [
        (ishigami as Formula, exact_ishigami()),
        (sobol_g, exact_g()),
    ] {
        let found = about(&study("design: saltelli\nruns: 20480\nseed: 3"), formula);
        let sensitivity = found[0].sensitivity.as_ref().unwrap();
        assert_eq!(
            sensitivity.method,
            Estimator::Groups {
                groups: groups as u64
            }
        );
        for (estimates, exact) in estimates(sensitivity).iter().zip(exact) {
            for (estimate, exact) in estimates.iter().zip(exact) {
                // 95 % are 1.96 standard errors; Sobol' points scatter less than the random points that the interval
                // assumes
                let error = (estimate.high - estimate.low) / (2.0 * 1.96);
                assert!(
                    (estimate.value - exact).abs() < 4.0 * error,
                    "{estimate:?} is not {exact}"
                );
                // the mean over N groups of products, whose fourth moments are a few variances squared
                assert!(
                    error > 0.0 && error < 3.0 / f64::sqrt(groups),
                    "{estimate:?}"
                );
            }
        }
    }
}

#[test]
fn intervals_of_groups_hold_what_they_promise() {
    let exact = exact_ishigami();
    let (mut inside, mut all) = (0.0, 0.0);
    for seed in 0..12 {
        let found = about(
            &study(&format!("design: saltelli\nruns: 2560\nseed: {seed}")),
            ishigami,
        );
        for (found, exact) in estimates(found[0].sensitivity.as_ref().unwrap())
            .iter()
            .zip(exact)
        {
            for (found, exact) in found.iter().zip(exact) {
                inside += f64::from(u8::from((found.low..=found.high).contains(&exact)));
                all += 1.0;
            }
        }
    }
    // a binomial share of 0.95, less five of its standard deviations
    let least = 0.95 - 5.0 * f64::sqrt(0.95 * 0.05 / all);
    assert!(inside / all > least, "{inside} of {all}");
}

#[test]
fn groups_that_lost_a_run_are_left_out() {
    // the second response is missing for a > 3
    let found = about(&study("design: saltelli\nruns: 5120\nseed: 3"), ishigami);
    let Estimator::Groups { groups } = found[1].sensitivity.as_ref().unwrap().method else {
        panic!("groups");
    };
    // A or AB_a: a group is complete with the probability p², p = (3 + π)/2π
    let p: f64 = (3.0 + PI) / (2.0 * PI);
    assert!(
        (groups as f64 - 1024.0 * p * p).abs() < 5.0 * (1024.0 * p * p * (1.0 - p * p)).sqrt(),
        "{groups}"
    );
    assert_eq!(found[1].count + found[1].missing, 5120);
}

#[test]
fn a_polynomial_is_found_to_rounding() {
    // 2 a + b c: variances 4 π²/3 and (π²/3)²
    let (line, product) = (4.0 * PI * PI / 3.0, (PI * PI / 3.0).powi(2));
    let share = line / (line + product);
    let exact = [[share, share], [0.0, 1.0 - share], [0.0, 1.0 - share]];
    for design in ["monte carlo", "latin hypercube", "sobol"] {
        let found = about(&study(&format!("design: {design}\nruns: 200")), sobol_g);
        let sensitivity = found[1].sensitivity.as_ref().unwrap();
        let Estimator::Polynomial {
            degree, explained, ..
        } = sensitivity.method
        else {
            panic!("{sensitivity:?}");
        };
        assert!(
            degree >= 2 && (1.0 - explained).abs() < 1e-15,
            "{sensitivity:?}"
        );
        for (found, exact) in estimates(sensitivity).iter().zip(exact) {
            for (found, exact) in found.iter().zip(exact) {
                // normal equations: rounding times the square of a condition of a few
                assert!(
                    (found.value - exact).abs() < 1e-12,
                    "{design}: {found:?} is not {exact}"
                );
            }
        }
    }
}

#[test]
fn polynomials_of_normal_parameters_are_hermites() {
    // a + b² with standard normal a, b: variances 1 and 2; exp(0.5 z) of a lognormal c is not used
    let normal = "{ normal: { mean: 0, deviation: 1 } }";
    let parameters = format!(
        "{{ a: {normal}, b: {normal}, c: {{ lognormal: {{ median: 1, deviation: 0.5 }} }} }}"
    );
    let formula: Formula = |x| vec![x[0] + x[1] * x[1], x[2].ln()];
    let found = about(&with("design: sobol\nruns: 500", &parameters), formula);
    let shares = |response: usize| {
        let sensitivity = found[response].sensitivity.as_ref().unwrap();
        estimates(sensitivity)
            .iter()
            .map(|[main, _]| main.value)
            .collect::<Vec<_>>()
    };
    for (found, exact) in [
        (shares(0), [1.0 / 3.0, 2.0 / 3.0, 0.0]),
        (shares(1), [0.0, 0.0, 1.0]),
    ] {
        for (found, exact) in found.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-12, "{found} is not {exact}");
        }
    }
}

/// Checks that main and total indices have these values, up to the rounding of normal equations with a few terms: the
/// norms of terms are their weights within a few tenths, so that conditions are small.
fn assert_exact(about: &About, exact: Exact, what: &str) {
    let sensitivity = about.sensitivity.as_ref().unwrap();
    let Estimator::Polynomial { explained, .. } = sensitivity.method else {
        panic!("{sensitivity:?}");
    };
    assert!((1.0 - explained).abs() < 1e-12, "{what}: {sensitivity:?}");
    for (found, exact) in estimates(sensitivity).iter().zip(exact) {
        for (found, exact) in found.iter().zip(exact) {
            let worst = (found.value - exact)
                .abs()
                .max(found.high - found.value)
                .max(found.value - found.low);
            assert!(worst < 1e-10, "{what}: {found:?} is not {exact}");
        }
    }
}

#[test]
fn polynomials_of_values_have_the_indices_of_their_weights() {
    // a has the variance 2/3 about 2, c 9/4 about 1/2, b has one value
    let parameters =
        "{ a: { values: [1, 2, 3] }, b: { values: [4] }, c: { values: [0, 5], weights: [9, 1] } }";
    let formula: Formula = |x| vec![2.0 * (x[0] + x[2]), x[0] * x[1] * x[2]];
    let (a, c): (f64, f64) = (2.0 / 3.0, 9.0 / 4.0);
    let sum = [[a / (a + c); 2], [0.0; 2], [c / (a + c); 2]];
    // V = ā² V_c + c̄² V_a + V_a V_c
    let (of_a, of_c, both) = (0.25 * a, 4.0 * c, a * c);
    let product = [[of_a, of_a + both], [0.0; 2], [of_c, of_c + both]]
        .map(|pair| pair.map(|v| v / (of_a + of_c + both)));
    for design in ["monte carlo", "latin hypercube", "sobol"] {
        for runs in [200, 2000, 10_000] {
            let head = format!("design: {design}\nruns: {runs}");
            let found = about(&with(&head, parameters), formula);
            assert_exact(&found[0], sum, &head);
            assert_exact(&found[1], product, &head);
        }
    }
}

#[test]
fn any_function_of_values_is_found() {
    // 2 comes twice; three levels have the weights 1/2, 3/8, 1/8, and a jump separates them; b is uniform with the
    // variance π²/3
    let parameters = "{ a: { values: [2, 1, 2, 1e6], weights: [1, 4, 2, 1] }, b: { from: -pi, to: pi }, c: { values: [3, 3] } }";
    let formula: Formula = |x| {
        let f = if x[0] == 2.0 { 1.0 } else { 0.0 };
        vec![f + x[1] + x[2], f * x[1]]
    };
    let (p, b) = (0.375, PI * PI / 3.0);
    let f = p * (1.0 - p);
    let sum = [[f / (f + b); 2], [b / (f + b); 2], [0.0; 2]];
    // V_b p² belongs to b, V_b p (1 − p) to both
    let product = [[0.0, 1.0 - p], [p, 1.0], [0.0; 2]];
    for design in ["monte carlo", "latin hypercube", "sobol"] {
        let head = format!("design: {design}\nruns: 1000");
        let found = about(&with(&head, parameters), formula);
        assert_exact(&found[0], sum, &head);
        assert_exact(&found[1], product, &head);
    }
}

#[test]
fn values_that_come_seldom_or_never_leave_the_other_indices() {
    // between 0 and about 8 of 1000 runs have a = 1, or c = 7
    let rare = "weights: [997, 2, 1]";
    let parameters = format!(
        "{{ a: {{ values: [0, 1, 5], {rare} }}, b: {{ from: -pi, to: pi }}, c: {{ values: [3, 7, 1], {rare} }} }}"
    );
    // b³ − b depends on b only
    let formula: Formula = |x| vec![x[1].powi(3) - x[1], x[0] + x[1].sin() + x[2]];
    for seed in 0..8 {
        let head = format!("design: monte carlo\nruns: 1000\nseed: {seed}");
        let found = about(&with(&head, &parameters), formula);
        assert_exact(&found[0], [[0.0; 2], [1.0; 2], [0.0; 2]], &head);
        assert!(found[1].sensitivity.is_some(), "{head}");
    }
}

#[test]
fn a_polynomial_errs_by_no_more_than_it_leaves_unexplained() {
    // With y = p + r and |r|² = ε² V, an index of p differs from that of y by at most 2 ε + ε² in either part of the
    // fraction.
    for (formula, exact, least) in [
        (ishigami as Formula, exact_ishigami(), 0.99),
        (sobol_g, exact_g(), 0.8),
    ] {
        let found = about(
            &study("design: latin hypercube\nruns: 3000\nseed: 2"),
            formula,
        );
        let sensitivity = found[0].sensitivity.as_ref().unwrap();
        let Estimator::Polynomial { explained, .. } = sensitivity.method else {
            panic!("{sensitivity:?}");
        };
        assert!(explained > least && explained < 1.0, "{sensitivity:?}");
        let epsilon = (1.0 - explained).sqrt();
        for (found, exact) in estimates(sensitivity).iter().zip(exact) {
            for (found, exact) in found.iter().zip(exact) {
                let error = (found.value - exact).abs();
                assert!(
                    error < 2.0 * (2.0 * epsilon + epsilon * epsilon),
                    "{found:?} is not {exact}"
                );
            }
        }
    }
}

#[test]
fn moments_are_those_of_the_closed_form() {
    // Ishigami: mean 7/2; its variance is the sum of its parts
    let n = 8192.0;
    let found = about(&study("design: monte carlo\nruns: 8192\nseed: 8"), ishigami);
    let variance = 0.5 * (1.0 + 0.1 * PI.powi(4) / 5.0).powi(2)
        + 49.0 / 8.0
        + 0.01 * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let about = &found[0];
    assert!(
        (about.mean - 3.5).abs() < 5.0 * (variance / n).sqrt(),
        "{about:?}"
    );
    // the variance of a sample variance is about (κ − 1) V²/n, with κ = 3.5 for this function
    assert!(
        (about.deviation.powi(2) - variance).abs() < 5.0 * variance * (2.5 / n).sqrt(),
        "{about:?}"
    );
    let [low, median, high] = about.quantiles;
    let ordered = [about.minimum, low, median, high, about.maximum];
    assert!(ordered.is_sorted(), "{ordered:?}");
    let failed = found[1].missing as f64;
    let p = (PI - 3.0) / (2.0 * PI);
    assert!(
        (failed - p * n).abs() < 5.0 * (p * (1.0 - p) * n).sqrt(),
        "{failed}"
    );
}

#[test]
fn grids_are_told_correlations_alone() {
    let range = "{ from: -1, to: 1, steps: 5 }";
    let grid = with(
        "design: grid",
        &format!("{{ a: {range}, b: {range}, c: {range} }}"),
    );
    let formula: Formula = |x| vec![3.0 * x[0] - 4.0 * x[1], 1.0];
    let found = about(&grid, formula);
    assert!(found.iter().all(|about| about.sensitivity.is_none()));
    // parameters of a full grid are uncorrelated: 3/5 and −4/5
    for (found, exact) in found[0].correlations.iter().zip([0.6, -0.8, 0.0]) {
        assert!((found - exact).abs() < 1e-14, "{found} is not {exact}");
    }
    assert!(found[1].correlations.iter().all(|c| c.is_nan()));
}

#[test]
fn constants_and_few_runs_have_no_indices() {
    let constant: Formula = |_| vec![0.1, f64::NAN];
    for design in ["saltelli", "sobol"] {
        let found = about(&study(&format!("design: {design}\nruns: 500")), constant);
        assert!(
            found.iter().all(|about| about.sensitivity.is_none()),
            "{design}: {found:?}"
        );
        assert!(found[1].mean.is_nan() && found[1].missing == 500);
    }
    let few = about(&study("design: sobol\nruns: 5"), ishigami);
    assert!(few[0].sensitivity.is_none());
}

#[test]
fn a_constant_is_told_to_be_one() {
    let study = study("design: sobol\nruns: 500");
    let directory = tempfile::tempdir().unwrap();
    let folder = open(directory.path(), &study);
    let formula: Formula = |_| vec![0.0, 0.1];
    run(&study, &Closed(formula), &folder, Shard::WHOLE, 2, &|_| {}).unwrap();
    let (_, files) = report(&Results::new(&study, &folder, None).unwrap(), Format::Svg).unwrap();
    let [_, text, scatter] = &files[..] else {
        panic!("{files:?}")
    };
    let text = std::fs::read_to_string(text).unwrap();
    assert!(
        text.contains("final of force: the same in all 500 runs"),
        "{text}"
    );
    let scatter = std::fs::read_to_string(scatter).unwrap();
    assert!(!scatter.contains("e-30"), "{scatter}");
}

#[test]
fn a_report_is_the_same_whoever_runs_it() {
    let mut all = Vec::new();
    for (threads, shards) in [(1, 1), (3, 2)] {
        let study = study("design: saltelli\nruns: 1000");
        let directory = tempfile::tempdir().unwrap();
        let folder = open(directory.path(), &study);
        for index in 0..shards {
            let shard = Shard::new(index, shards).unwrap();
            run(&study, &Closed(ishigami), &folder, shard, threads, &|_| {}).unwrap();
        }
        let (_, files) =
            report(&Results::new(&study, &folder, None).unwrap(), Format::Svg).unwrap();
        let names: Vec<_> = files
            .iter()
            .map(|f| f.file_name().unwrap().to_owned())
            .collect();
        assert_eq!(
            names,
            ["summary.json", "summary.txt", "scatter.svg", "tornado.svg"]
        );
        all.push(
            files
                .iter()
                .map(|file| std::fs::read_to_string(file).unwrap())
                .collect::<Vec<_>>(),
        );
    }
    assert_eq!(all[0], all[1]);
    let json: serde_json::Value = serde_json::from_str(&all[0][0]).unwrap();
    assert_eq!(
        json["responses"][0]["sensitivity"]["method"]["groups"]["groups"],
        200
    );
    assert!(all[0][1].contains("final of force [N]"), "{}", all[0][1]);
    for picture in &all[0][2..] {
        assert!(picture.starts_with("<svg") && picture.contains("final of force"));
    }
}
