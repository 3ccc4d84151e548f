//! Tests of the properties that designs promise.

mod permutation;
mod sobol;

use bryant_study::design::permutation::Permutation;
use bryant_study::design::{PERMUTATION, Sampler, most_parameters};
use bryant_study::distribution::Distribution;
use bryant_study::study::{Keep, Levels, Listed, Plan, RandomDesign, RunSettings, Study, Varied};

fn study(rows: u64, parameters: usize, plan: Plan) -> Study {
    let varied = |p| Varied {
        name: format!("p{p}"),
        unit: String::new(),
        shown: String::new(),
    };
    Study {
        model: String::new(),
        rows,
        varied: (0..parameters).map(varied).collect(),
        fixed: Vec::new(),
        plan,
        run: RunSettings::default(),
        responses: Vec::new(),
        keep: Keep::default(),
        tables: Vec::new(),
    }
}

fn random(design: RandomDesign, rows: u64, parameters: usize) -> Study {
    let distributions = vec![Distribution::Uniform { from: 0.0, to: 1.0 }; parameters];
    study(
        rows,
        parameters,
        Plan::Random {
            design,
            seed: 5,
            distributions,
        },
    )
}

fn rows(study: &Study) -> Vec<Vec<f64>> {
    let sampler = Sampler::new(study).unwrap();
    let row = |index| {
        let mut values = vec![0.0; study.varied.len()];
        sampler.values(index, &mut values);
        values
    };
    (0..study.rows).map(row).collect()
}

#[test]
fn a_grid_counts_with_its_last_parameter_fastest() {
    let steps = Levels::Steps {
        from: 5.0,
        to: 7.0,
        count: 3,
    };
    let levels = vec![Levels::Values(vec![0.0, 1.0]), steps];
    let found = rows(&study(6, 2, Plan::Grid(levels)));
    let expected = [
        [0.0, 5.0],
        [0.0, 6.0],
        [0.0, 7.0],
        [1.0, 5.0],
        [1.0, 6.0],
        [1.0, 7.0],
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_list_is_as_written() {
    let list = Plan::List(Listed(vec![1.0, 2.0, 3.0, 4.0]));
    assert_eq!(rows(&study(2, 2, list)), [[1.0, 2.0], [3.0, 4.0]]);
}

#[test]
fn latin_hypercubes_have_one_point_in_each_stratum() {
    for n in (1..130).chain([1000, 4097]) {
        let points = rows(&random(RandomDesign::LatinHypercube, n, 3));
        for parameter in 0..3 {
            let mut seen = vec![false; n as usize];
            for point in &points {
                seen[(point[parameter] * n as f64) as usize] = true;
            }
            assert!(seen.iter().all(|&s| s), "n {n}, parameter {parameter}");
        }
    }
}

#[test]
fn the_last_stratum_of_a_billion_rows_keeps_its_points() {
    let study = random(RandomDesign::LatinHypercube, 1_000_000_000, 1);
    // the strata of the first parameter, with the seed of the study
    let strata = Permutation::new(study.rows, 5, PERMUTATION);
    let sampler = Sampler::new(&study).unwrap();
    for row in (0..study.rows).step_by(9_999_991) {
        let mut point = [0.0];
        sampler.point(row, &mut point);
        assert_eq!((point[0] * 1e9) as u64, strata.of(row), "row {row}");
    }
}

#[test]
fn means_and_variances_are_within_their_standard_errors() {
    // n independent uniform numbers have the mean ½ ± 1/√(12 n) and the variance 1/12 ± √(1/180 n); the other designs
    // are better
    let n = 8192u64;
    for design in [
        RandomDesign::MonteCarlo,
        RandomDesign::LatinHypercube,
        RandomDesign::Sobol,
    ] {
        let points = rows(&random(design, n, 20));
        for parameter in 0..20 {
            let mean = points.iter().map(|p| p[parameter]).sum::<f64>() / n as f64;
            let square = points
                .iter()
                .map(|p| (p[parameter] - 0.5).powi(2))
                .sum::<f64>()
                / n as f64;
            assert!(
                (mean - 0.5).abs() < 5.0 / (12.0 * n as f64).sqrt(),
                "{design:?}: mean {mean}"
            );
            let error = (square - 1.0 / 12.0).abs();
            assert!(
                error < 5.0 / (180.0 * n as f64).sqrt(),
                "{design:?}: variance {square}"
            );
        }
    }
}

#[test]
fn parameters_are_uncorrelated() {
    let n = 4096u64;
    for design in [
        RandomDesign::MonteCarlo,
        RandomDesign::LatinHypercube,
        RandomDesign::Sobol,
    ] {
        let points = rows(&random(design, n, 8));
        for (a, b) in (0..8).flat_map(|a| (0..a).map(move |b| (a, b))) {
            let product: f64 = points.iter().map(|p| (p[a] - 0.5) * (p[b] - 0.5)).sum();
            let correlation = 12.0 * product / n as f64;
            assert!(
                correlation.abs() < 5.0 / (n as f64).sqrt(),
                "{design:?} {a} {b}: {correlation}"
            );
        }
    }
}

#[test]
fn groups_of_saltelli_exchange_one_parameter_each() {
    let d = 3;
    let points = rows(&random(RandomDesign::Saltelli, 10 * 5, d));
    for group in points.chunks(d + 2) {
        let (a, b) = (&group[0], &group[1]);
        for i in 0..d {
            for j in 0..d {
                let expected = if i == j { b[j] } else { a[j] };
                assert_eq!(group[2 + i][j], expected);
                assert_ne!(a[j], b[j]);
            }
        }
    }
}

#[test]
fn rows_do_not_depend_on_the_order_they_are_asked_for() {
    use RandomDesign::*;
    for design in [MonteCarlo, LatinHypercube, Sobol, Saltelli] {
        let study = random(design, 60, 4);
        let forwards = rows(&study);
        let sampler = Sampler::new(&study).unwrap();
        let mut values = [0.0; 4];
        for row in (0..60).rev() {
            sampler.values(row, &mut values);
            assert_eq!(
                values.to_vec(),
                forwards[row as usize],
                "{design:?}, row {row}"
            );
        }
    }
}

#[test]
fn seeds_give_other_rows() {
    for design in [
        RandomDesign::MonteCarlo,
        RandomDesign::LatinHypercube,
        RandomDesign::Sobol,
    ] {
        let one = random(design, 100, 2);
        let mut other = one.clone();
        if let Plan::Random { seed, .. } = &mut other.plan {
            *seed += 1;
        }
        assert_ne!(rows(&one), rows(&other), "{design:?}");
    }
}

#[test]
fn sobol_integrates_better_than_chance() {
    // ∫ Π (1 + (u_i − ½)/(i + 1)) = 1; a scrambled net of 2^12 points has an error of about n^-1.5 √log^(d−1),
    // independent points n^-0.5/√12
    let n = 4096u64;
    let points = rows(&random(RandomDesign::Sobol, n, 6));
    let term = |point: &Vec<f64>| -> f64 {
        let factor = |(i, u): (usize, &f64)| 1.0 + (u - 0.5) / (i as f64 + 1.0);
        point.iter().enumerate().map(factor).product()
    };
    let error = (points.iter().map(term).sum::<f64>() / n as f64 - 1.0).abs();
    assert!(error < 1e-4, "{error}");
}

#[test]
fn sobol_numbers_end_at_their_dimensions() {
    let most = most_parameters(RandomDesign::Saltelli);
    assert!(Sampler::new(&random(RandomDesign::Saltelli, 300, most)).is_ok());
    assert!(Sampler::new(&random(RandomDesign::Saltelli, 300, most + 1)).is_err());
}
