mod report;

use bryant::stability::report::text::{summary, text};
use bryant::stability::{Outcome, run};
use bryant_generator::model::Model;
use bryant_hard::{Bench, Case, Engine, Trouble};
use bryant_hard::{Call, CaseModel, Group, Run};
use bryant_runtime::program::Job;

struct Nothing;

impl Engine for Nothing {
    fn run(&self, _: &CaseModel, _: &Job) -> Result<Run, Trouble> {
        Err(Trouble::System("nothing runs here".into()))
    }

    fn functions(&self, _: &Model) -> Box<Call> {
        Box::new(|_, _| f64::NAN)
    }
}

fn case(name: &'static str, run: fn(&mut Bench<'_>) -> Result<(), Trouble>) -> Case {
    Case {
        group: Group::Garbage,
        name,
        law: "a law",
        run,
    }
}

#[test]
fn a_case_that_panics_fails_with_its_message_and_the_others_run() {
    let cases = [
        case("panics", |bench| {
            bench.at_most("before", 1.0, 2.0, "", "one is less than two");
            panic!("broken {}", 7)
        }),
        case("panics in plain words", |_| panic!("just broken")),
        case("panics without words", |_| std::panic::panic_any(7)),
        case("holds", |bench| {
            bench.at_most("after", 1.0, 2.0, "", "one is less than two");
            Ok(())
        }),
    ];
    let outcomes = run(&cases, &Nothing, false, &mut |_| {});
    let holds: Vec<bool> = outcomes.iter().map(Outcome::holds).collect();
    assert_eq!(holds, [false, false, false, true]);
    let troubles: Vec<Option<Trouble>> = outcomes.iter().map(|o| o.trouble.clone()).collect();
    let panicked = |text: &str| Some(Trouble::Panicked(text.into()));
    assert_eq!(
        troubles,
        [
            panicked("broken 7"),
            panicked("just broken"),
            panicked("without a message"),
            None
        ]
    );
    assert_eq!(outcomes[0].checks.len(), 1, "what was found before stays");
    assert!(text(&outcomes, false).contains("broke off: the case panicked: broken 7"));
    assert!(summary(&outcomes).contains("3 cases broke off"));
}
