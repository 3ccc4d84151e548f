use bryant::accuracy::plan;
use bryant::accuracy::plan::{ModelFeatures, Range, Request, Series, series};
use bryant::accuracy::setting::{Pace, Scheme, Setting};
use bryant_runtime::Formula;
use bryant_runtime::program::Scalar;

fn request(quick: bool) -> Request {
    Request {
        schemes: Scheme::all(),
        tolerances: Range::new(1e-1, 1e-12).unwrap(),
        steps: Range::of_steps(2e-3, 0.16),
        quick,
    }
}

const ALL: ModelFeatures = ModelFeatures {
    kinks: true,
    sines: true,
};

#[test]
fn ladders_are_round_numbers_between_their_ends() {
    let ladder = |from, to, halves| Range::new(from, to).unwrap().ladder(halves);
    assert_eq!(ladder(1e-3, 1e-5, true), [1e-3, 3e-4, 1e-4, 3e-5, 1e-5]);
    assert_eq!(ladder(1e-5, 1e-3, false), [1e-3, 1e-4, 1e-5]);
    assert_eq!(ladder(2e-3, 4e-5, true), [2e-3, 1e-3, 3e-4, 1e-4, 4e-5]);
    assert_eq!(ladder(0.5, 0.5, true), [0.5]);
}

#[test]
fn usual_steps_fit_the_samples() {
    assert_eq!(Range::of_steps(2e-3, 0.16).largest(), 1e-3);
    assert_eq!(Range::of_steps(1e-2, 10.0).largest(), 1e-2);
    assert_eq!(Range::of_steps(0.05, 0.08).largest(), 3e-3);
    assert_eq!(Range::of_steps(3e-3, 1.0).largest(), 3e-3);
}

#[test]
fn ranges_are_read_and_refused() {
    let read = |text: &str| Range::read(text, |t| t.parse::<f64>());
    assert_eq!(read("1e-2..1e-8"), Range::new(1e-2, 1e-8));
    assert_eq!(read("1e-4"), Range::new(1e-4, 1e-4));
    for wrong in ["0..1e-3", "1e-3..-1", "nan", "x", "inf..1"] {
        assert!(read(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn every_formula_is_run_every_way() {
    let series = series(&request(false), ALL);
    for formula in Formula::ALL {
        for scalar in [Scalar::F64, Scalar::F32] {
            for locate in [true, false] {
                for adaptive in [false, true] {
                    let found = series.iter().any(|s| {
                        (s.of.formula, s.of.scalar, s.of.locate) == (formula, scalar, locate)
                            && !s.of.switches
                            && matches!(s.paces[0], Pace::Tolerance(_)) == adaptive
                    });
                    assert_eq!(found, !adaptive || formula.estimates_error());
                }
            }
        }
    }
    // settings go from coarse to fine, and none comes twice
    let settings: Vec<Setting> = series.iter().flat_map(Series::settings).collect();
    for (i, setting) in settings.iter().enumerate() {
        assert!(!settings[..i].contains(setting), "{}", setting.name());
    }
    for series in &series {
        let values: Vec<f64> = series.paces.iter().map(Pace::value).collect();
        assert!(values.windows(2).all(|pair| pair[0] > pair[1]));
    }
}

#[test]
fn what_cannot_differ_is_not_run() {
    let none = ModelFeatures {
        kinks: false,
        sines: false,
    };
    let series = series(&request(false), none);
    assert!(
        series
            .iter()
            .all(|s| s.of.locate && s.of.scalar != Scalar::Fast)
    );
    let quick = plan::series(&request(true), ALL);
    let count = |all: &[Series]| all.iter().map(|s| s.paces.len()).sum::<usize>();
    assert!(count(&quick) * 2 < count(&plan::series(&request(false), ALL)));
}
