//! Study files: their meaning, and the messages about invalid files.

use bryant_generator::Diagnostics;
use bryant_study::design::Sampler;
use bryant_study::distribution::Distribution;
use bryant_study::facts::{ModelFacts, OutputFact, ParameterFact, RunFact};
use bryant_study::file::StudyFile;
use bryant_study::hash;
use bryant_study::response::What;
use bryant_study::store::identity::{Identity, Program};
use bryant_study::study::{LaneFormula, Listed, Plan, RandomDesign, RunSettings, Study, TableKind};
use std::path::Path;

fn facts() -> ModelFacts {
    let parameter = |name: &str, unit: &str, default, min, max| ParameterFact {
        name: name.into(),
        unit: unit.into(),
        default,
        min,
        max,
    };
    let output = |name: &str, unit: &str| OutputFact {
        name: name.into(),
        unit: unit.into(),
        ..OutputFact::default()
    };
    ModelFacts {
        parameters: vec![
            parameter("lap_slack", "m", 0.01, Some(0.0), Some(0.1)),
            parameter("friction", "", 0.3, Some(0.0), Some(1.0)),
            parameter("pulse_scale", "", 1.0, Some(0.0), None),
            parameter("webbing_scale", "", 1.0, None, None),
            parameter("cushion_scale", "", 1.0, None, None),
            parameter("gravity", "m/s^2", 9.81, None, None),
        ],
        outputs: vec![
            output("lap belt force", "N"),
            output("head accelerometer", "m/s^2"),
            output("head excursion", "m"),
        ],
        unused: vec![("seat_angle".into(), "nothing depends on it".into())],
        run: RunFact {
            duration: 0.16,
            sampling: 1e-4,
        },
        ..ModelFacts::default()
    }
}

fn resolve(text: &str) -> Result<Study, Diagnostics> {
    StudyFile::parse("study.yaml", text)?.resolve(&facts(), Path::new("."))
}

/// A study with this design and these `parameters`, and with one response.
fn with(head: &str, parameters: &str) -> Result<Study, Diagnostics> {
    resolve(&format!(
        "model: seat\n{head}\nparameters:\n  {parameters}\nresponses: [{{ of: head excursion, what: peak }}]\n"
    ))
}

fn distribution(parameter: &str) -> Distribution {
    match with("design: sobol\nruns: 8", parameter).unwrap().plan {
        Plan::Random { distributions, .. } => distributions[0].clone(),
        other => panic!("{other:?}"),
    }
}

/// The only problem, on one line.
fn problem<T: std::fmt::Debug>(result: Result<T, Diagnostics>) -> String {
    let lines: Vec<String> = result.unwrap_err().lines().collect();
    assert_eq!(lines.len(), 1, "{lines:#?}");
    lines[0].clone()
}

const EXAMPLE: &str = "\
model: child-seat
design: sobol
runs: 4096
seed: 1
parameters:
  lap_slack:     { from: 0 mm, to: 60 mm }
  friction:      { normal: { mean: 0.3, deviation: 0.05 }, min: 0, max: 1 }
  pulse_scale:   { lognormal: { median: 1, deviation: 0.1 } }
  webbing_scale: { triangular: { from: 0.5, mode: 1, to: 2 } }
  cushion_scale: { values: [0.5, 1, 2] }
fixed: { gravity: 9.81 m/s^2 }
run: { duration: 120 ms, accuracy: 0.1 %, sampling: 0.1 ms }
responses:
  - { name: peak lap force, of: lap belt force, what: peak }
  - { of: head accelerometer, what: HIC15 }
  - { of: head accelerometer, what: clip, duration: 3 ms }
  - { of: head excursion, what: value, at: 80 ms }
keep: { runs: [17, 0], every: 1000, outputs: [head excursion] }
tables: [parquet, csv]
";

#[test]
fn an_example_means_what_it_says() {
    let study = resolve(EXAMPLE).unwrap();
    assert_eq!((study.model.as_str(), study.rows), ("child-seat", 4096));
    let Plan::Random {
        design,
        seed,
        distributions,
    } = &study.plan
    else {
        panic!("{:?}", study.plan);
    };
    assert_eq!(
        (*design, *seed, distributions.len()),
        (RandomDesign::Sobol, 1, 5)
    );
    assert_eq!(study.varied[0].unit, "m");
    assert_eq!(study.fixed[0].value, 9.81);
    assert_eq!(study.run.duration, Some(120.0 * 1e-3));
    assert_eq!(study.run.accuracy, Some(0.1 * 0.01));
    let names: Vec<&str> = study.responses.iter().map(|r| r.name.as_str()).collect();
    let expected = [
        "peak lap force",
        "HIC15 of head accelerometer",
        "3 ms clip of head accelerometer",
        "value at 80 ms of head excursion",
    ];
    assert_eq!(names, expected);
    assert_eq!(
        study.responses[2].what,
        What::Clip {
            duration: 3.0 * 1e-3
        }
    );
    assert_eq!(study.keep.runs, [0, 17]);
    assert_eq!(study.keep.outputs[0].index, 2);
    assert_eq!(study.tables, [TableKind::Parquet, TableKind::Csv]);
}

/// The settings of the runs of a study.
fn run(settings: &str) -> Result<RunSettings, Diagnostics> {
    let head = format!("design: sobol\nruns: 8\nrun: {settings}");
    with(&head, "friction: { from: 0.1, to: 0.2 }").map(|study| study.run)
}

#[test]
fn fixed_steps_have_a_method_and_no_accuracy() {
    let steps = |settings: &str| run(settings).unwrap().step.unwrap();
    let found = steps("{ step: 0.05 ms }");
    assert_eq!(
        (found.length, found.method),
        (0.05 * 1e-3, LaneFormula::Rk4)
    );
    for method in LaneFormula::ALL {
        let found = steps(&format!("{{ step: 1e-4, method: {} }}", method.word()));
        assert_eq!((found.length, found.method), (1e-4, method));
    }
    assert_eq!(run("{ accuracy: 1 % }").unwrap().step, None);
    let said = problem(run("{ method: rk4 }"));
    assert!(said.contains("there is no `step`"), "{said}");
    let said = problem(run("{ step: 1e-4, accuracy: 1 % }"));
    assert!(said.contains("remove `accuracy` or `step`"), "{said}");
    let said = problem(run("{ step: 1e-4, method: rk5 }"));
    assert!(said.contains("did you mean `rk4`?"), "{said}");
    let said = problem(run("{ step: 1e-4, duration: 1e-5 }"));
    assert!(said.contains("longer than the run"), "{said}");
}

#[test]
fn results_of_other_steps_and_of_another_precision_are_others() {
    let identity = |settings: &str| {
        let head = format!("design: sobol\nruns: 8\nrun: {settings}");
        let study = with(&head, "friction: { from: 0.1, to: 0.2 }").unwrap();
        let program = Program {
            model: String::new(),
            version: String::new(),
            arithmetic: String::new(),
        };
        Identity::of(&study, &program).unwrap().identity
    };
    assert_eq!(identity("{ precision: double }"), identity("{}"));
    assert_eq!(
        identity("{ step: 1e-4, method: rk4 }"),
        identity("{ step: 0.1 ms }")
    );
    let different = [
        "{}",
        "{ precision: single }",
        "{ step: 1e-4 }",
        "{ step: 2e-4 }",
        "{ step: 1e-4, method: heun }",
        "{ step: 1e-4, precision: single }",
    ];
    let mut identities = different.map(identity).to_vec();
    identities.sort();
    identities.dedup();
    assert_eq!(identities.len(), different.len());
    let said = problem(run("{ precision: half }"));
    assert!(said.contains("the words are `double`, `single`"), "{said}");
}

#[test]
fn distributions_are_read_with_their_units() {
    let found = distribution("lap_slack: { from: 10 mm, to: 0.05 }");
    assert_eq!(
        found,
        Distribution::Uniform {
            from: 0.01,
            to: 0.05
        }
    );
    let found = distribution(
        "lap_slack: { normal: { mean: 30 mm, deviation: 1 mm }, min: 20 mm, max: 40 mm }",
    );
    let [min, max] = [Some(0.02), Some(0.04)];
    assert_eq!(
        found,
        Distribution::Normal {
            mean: 0.03,
            deviation: 0.001,
            min,
            max
        }
    );
    let found = distribution("friction: { values: [0.1, 0.2], weights: [1, 3] }");
    assert_eq!(
        found,
        Distribution::Discrete {
            values: vec![0.1, 0.2],
            weights: vec![0.25, 0.75]
        }
    );
}

/// People read the values of a parameter in the unit of the study, whatever they are computed in.
#[test]
fn parameters_are_shown_in_the_unit_that_the_study_states() {
    let shown = |parameter: &str| {
        let study = with("design: sobol\nruns: 8", parameter).unwrap();
        (study.varied[0].unit.clone(), study.varied[0].shown.clone())
    };
    for (parameter, unit, expected) in [
        ("lap_slack: { from: 0 mm, to: 60 mm }", "m", "mm"),
        ("lap_slack: { from: 0, to: 0.6 dm }", "m", "dm"),
        ("lap_slack: { values: [1e-2, 2e1 mm, 0.05 m] }", "m", "mm"),
        ("lap_slack: { from: 0, to: 0.06 }", "m", "m"),
        // an expression has no unit of its own
        ("lap_slack: { from: 0, to: 2 * 30 mm }", "m", "m"),
        ("friction: { from: 10 %, to: 50 % }", "", ""),
        (
            "gravity: { normal: { mean: 1 m/s^2, deviation: 0.1 m/s^2 } }",
            "m/s^2",
            "m/s^2",
        ),
    ] {
        assert_eq!(
            shown(parameter),
            (unit.into(), expected.into()),
            "{parameter}"
        );
    }
    let rows = |rows: &str| {
        let text = format!(
            "model: seat\ndesign: list\nrows: {rows}\nresponses: [{{ of: head excursion, what: peak }}]\n"
        );
        let units = resolve(&text)
            .unwrap()
            .varied
            .into_iter()
            .map(|one| one.shown);
        units.collect::<Vec<_>>()
    };
    assert_eq!(
        rows("[{ friction: 0.2 }, { lap_slack: 3 mm, friction: 0.1 }]"),
        ["", "mm"]
    );
}

#[test]
fn a_lognormal_tail_needs_no_lower_end_at_zero() {
    let found = distribution("pulse_scale: { lognormal: { median: 1, deviation: 0.1 } }");
    assert_eq!(found.support(), [0.0, f64::INFINITY]);
}

#[test]
fn a_grid_has_all_combinations() {
    let study = with(
        "design: grid",
        "lap_slack: { from: 0 mm, to: 60 mm, steps: 7 }\n  friction: { values: [0.2, 0.4] }",
    )
    .unwrap();
    assert_eq!(study.rows, 14);
    let Plan::Grid(levels) = study.plan else {
        panic!("a grid")
    };
    // steps of 10 mm, up to the rounding of one sum
    for k in 0..7 {
        let level = levels[0].value(k);
        assert!((level - 0.01 * k as f64).abs() < 1e-17, "{level}");
    }
    assert_eq!((levels[0].value(0), levels[0].value(6)), (0.0, 0.06));
}

#[test]
fn a_grid_that_is_too_large_is_counted_without_being_made() {
    let parameters = "lap_slack: { from: 0, to: 0.1, steps: 1e6 }\n  friction: { from: 0, to: 1, steps: 1e6 }\n  gravity: { from: 0, to: 1, steps: 1e6 }";
    let message = problem(with("design: grid", parameters));
    assert!(
        message.contains("1e18 runs") && message.contains("1000000 of lap_slack"),
        "{message}"
    );
}

#[test]
fn saltelli_takes_whole_groups() {
    let parameters = "lap_slack: { from: 0, to: 0.1 }\n  friction: { from: 0, to: 1 }";
    assert_eq!(
        with("design: saltelli\nruns: 1003", parameters)
            .unwrap()
            .rows,
        1000
    );
    let message = problem(with("design: saltelli\nruns: 3", parameters));
    assert!(message.contains("a group is 4 runs"), "{message}");
}

#[test]
fn lists_take_defaults_for_what_they_leave_out() {
    let text = "model: seat\ndesign: list\nrows:\n  - { lap_slack: 10 mm, friction: 0.2 }\n  - { friction: 0.5 }\nresponses: [{ of: head excursion, what: peak }]\n";
    let study = resolve(text).unwrap();
    let Plan::List(list) = &study.plan else {
        panic!("a list")
    };
    assert_eq!(list.0, [10.0 * 1e-3, 0.2, 0.01, 0.5]);
    assert_eq!(study.rows, 2);
}

#[test]
fn lists_are_read_from_csv_with_units_in_headings() {
    let directory = tempfile::tempdir().unwrap();
    let text = "model: seat\ndesign: list\nrows: { csv: rows.csv }\nresponses: [{ of: head excursion, what: peak }]\n";
    let read = |csv: &str| {
        std::fs::write(directory.path().join("rows.csv"), csv).unwrap();
        StudyFile::parse("study.yaml", text)
            .unwrap()
            .resolve(&facts(), directory.path())
    };
    let study = read("friction, lap_slack [mm]\n0.2, 10\n0.5, 2 cm\n").unwrap();
    let Plan::List(list) = &study.plan else {
        panic!("a list")
    };
    assert_eq!(list.0, [0.2, 10.0 * 1e-3, 0.5, 2.0 * 1e-2]);
    assert_eq!(
        (&*study.varied[0].shown, &*study.varied[1].shown),
        ("", "mm")
    );
    let message = problem(read("friction,lap_slack\n0.2,0.01\n0.2,7\n"));
    assert!(
        message.starts_with("rows.csv:3:5") && message.contains("from 0 to 0.1 m"),
        "{message}"
    );
    let message = problem(read("frictoin\n0.2\n"));
    assert!(message.contains("did you mean \"friction\""), "{message}");
    assert!(problem(read("friction\n")).contains("no rows"));
    assert!(problem(read("friction,lap_slack\n1\n")).contains("has 1 field"));
}

#[test]
fn all_problems_are_told_at_once_each_at_its_line() {
    let text = "\
model: seat
design: sobol
runs: 0
parameters:
  lap_slak: { from: 0 mm, to: 60 mm }
  friction: { from: 0.5, to: 1.5 }
  gravity: { from: 2 kg, to: 3 }
colour: blue
responses:
  - { of: head excursoin, what: peak }
  - { of: head excursion, what: HIC15 }
  - { of: head excursion, what: peek }
keep: { runs: [-1] }
";
    let problems = resolve(text).unwrap_err();
    let lines: Vec<String> = problems.lines().collect();
    let expected = [
        ("study.yaml:3:", "at least 1"),
        ("study.yaml:5:", "did you mean \"lap_slack\"?"),
        ("study.yaml:8:", "no key \"colour\""),
        ("study.yaml:10:", "did you mean \"head excursion\"?"),
        ("study.yaml:11:", "name an output in m/s^2"),
        ("study.yaml:12:", "did you mean \"peak\"?"),
        ("study.yaml:13:", "not a whole number"),
    ];
    for (place, words) in expected {
        let told = lines
            .iter()
            .any(|line| line.starts_with(place) && line.contains(words));
        assert!(told, "{place} {words}: {lines:#?}");
    }
    assert_eq!(lines.len(), expected.len(), "{lines:#?}");
}

#[test]
fn ranges_keep_to_the_bounds_of_the_model() {
    for (parameter, words) in [
        (
            "friction: { from: 0.5, to: 1.5 }",
            "in the model it is from 0 to 1",
        ),
        (
            "friction: { values: [0.5, 1.5] }",
            "1.5 of \"friction\" is out",
        ),
        (
            "lap_slack: { triangular: { from: -1 mm, mode: 0, to: 1 mm } }",
            "from 0 to 0.1 m",
        ),
        (
            "friction: { normal: { mean: 0.3, deviation: 0.05 } }",
            "cut them off by `min: 0`, `max: 1`",
        ),
        (
            "friction: { normal: { mean: 0.3, deviation: 0.05 }, min: 0 }",
            "cut them off by `max: 1`",
        ),
        (
            "friction: { normal: { mean: 0.3, deviation: 0.05 }, min: 0, max: 2 }",
            "leave its bounds",
        ),
        (
            "friction: { lognormal: { median: 0.3, deviation: 0.5 } }",
            "cut them off by `max: 1`",
        ),
        (
            "friction: { from: 0.5, to: 0.5 }",
            "`from` is less than `to`",
        ),
        (
            "friction: { normal: { mean: 0.3, deviation: 0 } }",
            "greater than 0",
        ),
        (
            "friction: { lognormal: { median: -1, deviation: 1 } }",
            "greater than 0",
        ),
        (
            "friction: { normal: { mean: 0, deviation: 1e-3 }, min: 0.9, max: 1 }",
            "has no probability",
        ),
        (
            "friction: { triangular: { from: 0, mode: 2, to: 1 } }",
            "the mode 2 is not between",
        ),
        ("friction: { values: [] }", "at least one"),
        (
            "friction: { values: [0.1], weights: [1, 1] }",
            "one weight per value",
        ),
        (
            "friction: { from: 0, to: 1, steps: 3 }",
            "steps are those of `design: grid`",
        ),
        ("friction: 3", "a varied parameter has keys"),
        ("friction: { from: 1 kg, to: 1 }", "in kg"),
    ] {
        let message = problem(with("design: sobol\nruns: 8", parameter));
        assert!(message.contains(words), "{parameter}: {message}");
    }
}

// a table of cases
#[test]
fn keys_that_have_no_meaning_are_told() {
    for (head, parameter, words) in [
        (
            "design: grid\nruns: 8",
            "friction: { values: [0.1] }",
            "`runs` has no meaning",
        ),
        (
            "design: sobol\nruns: 8\nrows: []",
            "friction: { from: 0, to: 1 }",
            "`rows` has no meaning",
        ),
        (
            "design: sobol",
            "friction: { from: 0, to: 1 }",
            "`runs` is missing",
        ),
        (
            "design: sobo\nruns: 8",
            "friction: { from: 0, to: 1 }",
            "did you mean `sobol`?",
        ),
        (
            "design: sobol\nruns: 8\nseed: -2",
            "friction: { from: 0, to: 1 }",
            "not a whole number",
        ),
        (
            "design: sobol\nruns: 2e9",
            "friction: { from: 0, to: 1 }",
            "at most 1e9",
        ),
        (
            "design: sobol\nruns: 8\nfixed: { friction: 0.1 }",
            "friction: { from: 0, to: 1 }",
            "varied and fixed",
        ),
        (
            "design: sobol\nruns: 8\nfixed: { lap_slack: 1 }",
            "friction: { from: 0, to: 1 }",
            "out of the bounds",
        ),
        (
            "design: sobol\nruns: 8\nrun: { step: -1 }",
            "friction: { from: 0, to: 1 }",
            "greater than 0",
        ),
        (
            "design: sobol\nruns: 8\nrun: { accuracy: 1 }",
            "friction: { from: 0, to: 1 }",
            "such as `0.1 %`",
        ),
        (
            "design: sobol\nruns: 8\nrun: { duration: 1 ms, sampling: 1 s }",
            "friction: { from: 0, to: 1 }",
            "longer than the run",
        ),
        (
            "design: sobol\nruns: 8\nkeep: { runs: [8] }",
            "friction: { from: 0, to: 1 }",
            "no run 8",
        ),
        (
            "design: sobol\nruns: 8\nkeep: { outputs: [head excursion] }",
            "friction: { from: 0, to: 1 }",
            "names no runs",
        ),
        (
            "design: sobol\nruns: 1e18",
            "friction: { from: 0, to: 1 }",
            "too large",
        ),
        (
            "design: sobol\nruns: 8\ntables: [exel]",
            "friction: { from: 0, to: 1 }",
            "\"exel\" is none of the words",
        ),
        (
            "design: grid",
            "friction: { from: 0, to: 1 }",
            "`steps` is missing",
        ),
        (
            "design: grid",
            "friction: { from: 0, to: 1, steps: 1 }",
            "at least 2 steps",
        ),
    ] {
        let message = problem(with(head, parameter));
        assert!(message.contains(words), "{head}: {message}");
    }
}

#[test]
fn an_empty_text_is_no_name() {
    let parameters = "parameters: { friction: { from: 0, to: 1 } }";
    for (rows, rest) in [
        (
            "design: sobol\nruns: 8",
            "responses: [{ of: \"\", what: peak }]",
        ),
        (
            "design: sobol\nruns: 8",
            "responses: [{ of: head excursion, what: \" \" }]",
        ),
        ("design: sobol\nruns: 8", "responses: [{ criterion: \"\" }]"),
        (
            "design: sobol\nruns: 8",
            "responses: [{ of: head excursion, what: peak, name: \"\" }]",
        ),
        (
            "design: sobol\nruns: 8",
            "responses: [{ of: head excursion, what: peak, filter: \"\" }]",
        ),
        (
            "design: sobol\nruns: 8",
            "responses: [{ of: head excursion, what: peak }]\nkeep: { runs: [0], outputs: [\"\"] }",
        ),
    ] {
        let said = problem(resolve(&format!(
            "model: seat\n{rows}\n{parameters}\n{rest}\n"
        )));
        assert!(said.contains("an empty text"), "{rest}: {said}");
    }
    let said = problem(resolve(
        "model: seat\ndesign: list\nrows: { csv: \"\" }\nresponses: [{ of: head excursion, what: peak }]\n",
    ));
    assert!(said.contains("an empty text"), "{said}");
}

#[test]
fn columns_have_different_names() {
    let text = "model: seat\ndesign: sobol\nruns: 8\nparameters: { friction: { from: 0, to: 1 } }\nresponses:\n";
    for (responses, name) in [
        (
            "  - { of: head excursion, what: peak }\n  - { of: head excursion, what: peak }\n",
            "peak of head excursion",
        ),
        (
            "  - { name: friction, of: head excursion, what: peak }\n",
            "friction",
        ),
        (
            "  - { name: status, of: head excursion, what: peak }\n",
            "status",
        ),
    ] {
        let message = problem(resolve(&format!("{text}{responses}")));
        assert!(
            message.contains("two columns") && message.contains(name),
            "{message}"
        );
    }
}

#[test]
fn responses_say_what_time_they_need() {
    let text = "model: seat\ndesign: sobol\nruns: 8\nparameters: { friction: { from: 0, to: 1 } }\nrun: { duration: 1 s }\nresponses: [{ of: head excursion, ";
    for (response, words) in [
        ("what: clip", "`duration` is missing"),
        ("what: value", "`at` is missing"),
        ("what: peak, at: 1 ms", "`at` has no meaning"),
        ("what: clip, duration: 0 ms", "greater than 0"),
        ("what: value, at: 2 s", "beyond the end"),
        ("what: value, at: 2 m", "in m"),
        ("what: peak, name: \"a\\nb\"", "a single line"),
    ] {
        let message = problem(resolve(&format!("{text}{response} }}]\n")));
        assert!(message.contains(words), "{response}: {message}");
    }
}

#[test]
fn where_a_study_is_silent_the_run_of_the_model_counts() {
    let text =
        "model: seat\ndesign: sobol\nruns: 8\nparameters: { friction: { from: 0, to: 1 } }\n";
    for (run, response, words) in [
        (
            "",
            "of: head excursion, what: value, at: 1 s",
            "end of the run at 0.16 s",
        ),
        (
            "",
            "of: head excursion, what: clip, duration: 1 s",
            "end of the run at 0.16 s",
        ),
        (
            "sampling: 1 s",
            "of: head excursion, what: peak",
            "longer than the run of 0.16 s",
        ),
        (
            "step: 1 s",
            "of: head excursion, what: peak",
            "longer than the run of 0.16 s",
        ),
        (
            "sampling: 20 ms",
            "of: head accelerometer, what: HIC15",
            "a sample every 0.02 s",
        ),
        (
            "sampling: 5 ms",
            "of: head excursion, what: clip, duration: 3 ms",
            "a sample every 0.005 s",
        ),
        (
            "duration: 0.1 s",
            "of: head excursion, what: value, at: 0.15 s",
            "end of the run at 0.1 s",
        ),
    ] {
        let text = format!("{text}run: {{ {run} }}\nresponses: [{{ {response} }}]\n");
        let message = problem(resolve(&text));
        assert!(message.contains(words), "{run}, {response}: {message}");
    }
    for (run, response) in [
        ("", "of: head excursion, what: value, at: 160 ms"),
        ("duration: 1 s", "of: head excursion, what: value, at: 1 s"),
        ("sampling: 15 ms", "of: head accelerometer, what: HIC15"),
    ] {
        let text = format!("{text}run: {{ {run} }}\nresponses: [{{ {response} }}]\n");
        assert!(resolve(&text).is_ok(), "{run}, {response}");
    }
}

#[test]
fn a_parameter_that_changes_nothing_is_said_to() {
    let message = problem(with(
        "design: sobol\nruns: 8",
        "seat_angle: { from: 0, to: 1 }",
    ));
    assert!(
        message.contains("changes nothing: nothing depends on it"),
        "{message}"
    );
}

#[test]
fn a_file_of_rows_that_has_none_says_so() {
    let folder = tempfile::tempdir().unwrap();
    for (rows, words) in [
        ("", "it is empty"),
        ("lap_slack\n", "it has no rows"),
        ("lap_slack;lap_slack\n1;2\n", "two columns are named"),
        ("lap_slack\n1,5\n", "write decimals behind a point"),
        (
            "lap_slack,friction\n0.01,0.2\n0,02,0.2\n",
            "write decimals behind a point",
        ),
    ] {
        std::fs::write(folder.path().join("rows.csv"), rows).unwrap();
        let text = "model: seat\ndesign: list\nrows: { csv: rows.csv }\nresponses: [{ of: head excursion, what: peak }]\n";
        let file = StudyFile::parse("study.yaml", text).unwrap();
        let message = problem(file.resolve(&facts(), folder.path()));
        assert!(message.contains(words), "{rows}: {message}");
    }
}

#[test]
fn rows_are_read_as_all_tables_are() {
    let folder = tempfile::tempdir().unwrap();
    let text = "model: seat\ndesign: list\nrows: { csv: rows.csv }\nresponses: [{ of: head excursion, what: peak }]\n";
    let mut found = Vec::new();
    for rows in [
        "lap_slack [mm],friction\n10,0.2\n20 mm,0.3\n",
        "\u{feff}# of a test\r\nlap_slack (mm);friction\r\n10;0.2\r\n\r\n20;0.3;\r\n",
        "lap_slack/mm\tfriction\n10\t0.2\n20\t\"0.3\"\n",
    ] {
        std::fs::write(folder.path().join("rows.csv"), rows).unwrap();
        let file = StudyFile::parse("study.yaml", text).unwrap();
        let study = file.resolve(&facts(), folder.path()).unwrap();
        let Plan::List(Listed(values)) = study.plan else {
            panic!("{rows}");
        };
        found.push(values);
    }
    let expected = vec![0.01, 0.2, 0.02, 0.3];
    assert_eq!(found, [expected.clone(), expected.clone(), expected]);
}

#[test]
fn what_is_no_study_is_an_error() {
    for text in [
        "",
        "model:",
        "a: [",
        "- 1",
        "model: [a]",
        "model: x\nmodel: y",
        "design: sobol",
    ] {
        assert!(StudyFile::parse("study.yaml", text).is_err(), "{text}");
    }
    let bare = problem(resolve(
        "model: seat\ndesign: sobol\nruns: 8\nresponses: [{ of: head excursion, what: peak }]",
    ));
    assert!(bare.contains("`parameters` is missing"), "{bare}");
}

/// A text with some pieces removed, moved, or replaced by meaningless numbers.
fn mangled(case: u64) -> String {
    let number = |k: u64, below: usize| (hash::uniform(17, case, k) * below as f64) as usize;
    let pieces = [
        "-1", "1e308", "nan", "{", "]", "0", ": ", "\n", "grid", "1e18", "saltelli", "'", "kg",
        "\u{fe0f}", "list",
    ];
    let mut text: Vec<char> = EXAMPLE.chars().collect();
    for change in 0..1 + number(0, 4) as u64 {
        let at = number(3 * change + 1, text.len());
        let end = (at + number(3 * change + 2, 12)).min(text.len());
        let piece = pieces[number(3 * change + 3, pieces.len())];
        text.splice(at..end, piece.chars());
    }
    text.into_iter().collect()
}

#[test]
fn mangled_studies_are_studies_or_errors_with_a_place() {
    let mut sound = 0;
    for case in 0..3000 {
        let text = mangled(case);
        match resolve(&text) {
            Ok(study) => {
                sound += 1;
                let sampler = Sampler::new(&study).unwrap();
                let mut values = vec![0.0; study.varied.len()];
                for row in [0, study.rows - 1] {
                    sampler.values(row, &mut values);
                    assert!(!values.iter().any(|x| x.is_nan()), "{text}");
                }
            }
            Err(problems) => {
                for problem in &problems.problems {
                    assert!(
                        problem.line > 0 && !problem.help.is_empty(),
                        "{text}\n{problem}"
                    );
                }
            }
        }
    }
    assert!(sound > 0);
}
