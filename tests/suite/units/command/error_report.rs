use bryant::accuracy::check;
use bryant::accuracy::check::Verdict;
use bryant::command::Error;
use bryant::command::error_report::{ErrorReport, at_most};
use bryant::equations::Engine;
use bryant::simulation::Runs;
use bryant::{bundled, equations};
use bryant_runtime::Info;
use bryant_runtime::program::{Job, Observer, Outcome, SampleWriter};
use std::cell::Cell;
use std::time::Duration;

#[test]
fn what_is_told_of_an_error_is_no_less_than_it() {
    for (share, text) in [
        (8.8e-6, "0.0009 %"),
        (1.2e-4, "0.02 %"),
        (1e-3, "0.1 %"),
        (0.0151, "2 %"),
        (3.3e-9, "4e-7 %"),
        (1e-15, "rounding"),
    ] {
        assert_eq!(at_most(share), text);
    }
}

/// A model that runs the first job as requested, and every later job as `then` changes it.
struct Once {
    engine: Engine,
    taken: Cell<bool>,
    then: fn(&Job) -> Job,
}

impl Runs for Once {
    fn info(&self) -> &Info<'_> {
        self.engine.info()
    }

    fn run(
        &self,
        job: &Job,
        writer: &mut SampleWriter<'_>,
        observer: &mut Observer<'_>,
    ) -> Outcome {
        match self.taken.replace(true) {
            false => self.engine.run(job, writer, observer),
            true => self.engine.run(&(self.then)(job), writer, observer),
        }
    }
}

fn checked(then: fn(&Job) -> Job) -> ErrorReport {
    let found = bundled::find("sled-pendulum").expect("it is bundled");
    let model = bundled::model(found).expect("it is right");
    let once = Once {
        engine: equations::of(&model).expect("without functions of a user"),
        taken: Cell::new(false),
        then,
    };
    {
        let checked = check::run(&once, &Job::default(), false, &mut |_, _| {});
        ErrorReport::new(&checked.recording.header, checked.certainty)
    }
}

/// On a busy machine milliseconds of work may take a hundred times as long.
#[test]
fn a_check_has_far_more_time_than_it_needs() {
    let checked = checked(|job| {
        assert!(
            job.time_limit
                .is_some_and(|limit| limit > Duration::from_secs(5))
        );
        job.clone()
    });
    assert!(matches!(checked.known.check, Some((_, Verdict::Apart(_)))));
}

/// A promise that cannot be checked is an error; a check that takes too long is only reported.
#[test]
fn a_check_that_fails_is_an_error_and_one_without_time_is_not() {
    let good = checked(Job::clone);
    assert!(good.check().is_ok());
    let failed = checked(|job| Job {
        max_steps: Some(3),
        ..job.clone()
    });
    let lines = failed.lines().join("\n");
    assert!(
        lines.contains("not checked") && lines.contains("limit of 3 steps"),
        "{lines}"
    );
    match failed.check() {
        Err(Error::Run(error)) => {
            assert_eq!(error.kind.exit_code(), 3);
            assert!(error.message.contains("could not be checked"), "{error}");
        }
        other => panic!("{other:?}"),
    }
    let late = checked(|job| Job {
        time_limit: Some(Duration::ZERO),
        ..job.clone()
    });
    let lines = late.lines().join("\n");
    assert!(lines.contains("takes longer than"), "{lines}");
    assert!(late.check().is_ok());
}
