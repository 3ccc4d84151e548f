use bryant::sweep::plan::pace;
use bryant_study::study;
use bryant_study::study::{FixedSteps, Precision, RunSettings};

fn run(step: Option<f64>, accuracy: Option<f64>, precision: Precision) -> RunSettings {
    RunSettings {
        accuracy,
        step: step.map(|length| FixedSteps {
            length,
            method: study::LaneFormula::Merson,
        }),
        precision,
        ..RunSettings::default()
    }
}

#[test]
fn names_of_methods_are_those_of_the_runtime() {
    for method in study::LaneFormula::ALL {
        let mut run = run(Some(1e-3), None, Precision::Double);
        run.step = run.step.map(|step| FixedSteps { method, ..step });
        let pace = pace(&run, 1.0).unwrap();
        assert_eq!(pace.method().formula().name(), method.word());
    }
}

#[test]
fn singles_are_asked_for_no_more_than_they_hold() {
    let adaptive = |accuracy, precision| pace(&run(None, Some(accuracy), precision), 0.1);
    // the tolerance of a step is 10⁻³ of the accuracy, and single precision resolves 2⁻²³: 1.19·10⁻⁴
    assert!(adaptive(1.2e-4, Precision::Single).is_ok());
    let said = adaptive(1.19e-4, Precision::Single).unwrap_err();
    assert!(said.contains("aim at 1.2e-4 or more"), "{said}");
    assert!(adaptive(1e-9, Precision::Double).is_ok());
    assert!(pace(&run(None, None, Precision::Single), 0.1).is_ok());

    let fixed = |step, precision| pace(&run(Some(step), None, precision), 0.1);
    // 16 · 2⁻²³ · 0.1 s = 1.9·10⁻⁷ s
    assert!(fixed(2e-7, Precision::Single).is_ok());
    let said = fixed(1.9e-7, Precision::Single).unwrap_err();
    assert!(said.contains("precision: double"), "{said}");
    assert!(fixed(1.9e-7, Precision::Double).is_ok());
}

#[test]
fn steps_beyond_all_bounds_are_refused() {
    let fixed = |step| pace(&run(Some(step), None, Precision::Double), 0.1);
    assert!(fixed(1e-7).is_ok());
    let said = fixed(0.9e-7).unwrap_err();
    assert!(said.contains("at most 1000000 are taken"), "{said}");
}
