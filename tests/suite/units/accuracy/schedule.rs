use bryant::accuracy::front::Cost;
use bryant::accuracy::plan::Series;
use bryant::accuracy::point::{Point, Status};
use bryant::accuracy::schedule::{NONE, Ran, Schedule};
use bryant::accuracy::setting::{Pace, Setting};
use bryant_runtime::Formula;
use bryant_runtime::program::Scalar;
use std::sync::Mutex;

fn series(formula: Formula) -> Series {
    Series {
        of: Setting {
            formula,
            switches: false,
            pace: Pace::Step(1.0),
            scalar: Scalar::F64,
            locate: true,
        },
        paces: (0..8).map(|i| Pace::Step(0.1f64.powi(i))).collect(),
    }
}

fn order_of(formula: Formula) -> i32 {
    if formula == Formula::Rk4 { 4 } else { 1 }
}

/// A method of order 1 and one of order 4, equally fast at equal steps: the second one gets more runs.
#[test]
fn more_is_run_where_the_front_is() {
    let all = [series(Formula::SemiImplicitEuler), series(Formula::Rk4)];
    let schedule = Schedule::new(&all, 1e3, 60.0).on(1);
    let taken = Mutex::new(Vec::new());
    let run = |setting: &Setting, _: f64| {
        let step = setting.pace.value();
        taken.lock().unwrap().push((setting.formula, step));
        let cost = Cost {
            error: 0.5 * step.powi(order_of(setting.formula)),
            time: 1e-6 / step,
        };
        (Status::Failed(String::new()), cost)
    };
    let points = schedule.carry_out(&run, &mut |_| {});
    assert_eq!(points.len(), 16);
    let taken = taken.into_inner().unwrap();
    let place = |formula, step: f64| {
        let found = taken
            .iter()
            .position(|t| t.0 == formula && (t.1 / step - 1.0).abs() < 1e-9);
        found.unwrap()
    };
    // The two take turns until the better one is known, which is then finished first.
    assert!(place(Formula::Rk4, 1e-7) < place(Formula::SemiImplicitEuler, 1e-3));
}

#[test]
fn what_would_take_too_long_is_skipped_and_says_so() {
    let all = [series(Formula::Rk4)];
    let schedule = Schedule::new(&all, 1e-3, 60.0);
    let run = |setting: &Setting, _: f64| {
        let cost = Cost {
            error: setting.pace.value(),
            time: 1e-5 / setting.pace.value(),
        };
        (Status::Failed("ran".into()), cost)
    };
    let points = schedule.carry_out(&run, &mut |_| {});
    let ran = |p: &&Point| matches!(p.status, Status::Failed(_));
    assert_eq!(points.iter().filter(ran).count(), 3);
    let Status::Skipped(why) = &points[3].status else {
        panic!("{:?}", points[3])
    };
    assert!(
        why.contains("would take about") && why.contains("--budget"),
        "{why}"
    );
}

/// A run of 0.4 s after one of 1 ms, far more than predicted: it is stopped at first, and run again when nothing else
/// is left.
#[test]
fn what_was_predicted_wrongly_is_run_with_more_time() {
    let mut all = [series(Formula::Tsit5)];
    all[0].paces.truncate(2);
    let schedule = Schedule::new(&all, 1.0, 60.0).on(1);
    let allowed = Mutex::new(Vec::new());
    let run = |setting: &Setting, limit: f64| -> Ran {
        allowed.lock().unwrap().push(limit);
        let time = if setting.pace.value() == 1.0 {
            1e-3
        } else {
            0.4
        };
        match time <= limit {
            true => (Status::Failed("ran".into()), Cost { error: 0.1, time }),
            false => (Status::Skipped("stopped".into()), NONE),
        }
    };
    let points = schedule.carry_out(&run, &mut |_| {});
    assert!(
        points.iter().all(|p| matches!(p.status, Status::Failed(_))),
        "{points:?}"
    );
    let allowed = allowed.into_inner().unwrap();
    assert!(
        allowed.len() > 2 && allowed.is_sorted_by(|a, b| *a == 0.25 || a < b),
        "{allowed:?}"
    );
}

#[test]
fn when_the_time_is_used_up_nothing_begins() {
    let all = [series(Formula::Rk4)];
    let schedule = Schedule::new(&all, 1.0, 0.0);
    let run = |_: &Setting, _: f64| -> Ran { unreachable!("no time is left") };
    let points = schedule.carry_out(&run, &mut |_| {});
    let reached =
        |p: &Point| matches!(&p.status, Status::Skipped(why) if why.contains("not reached"));
    assert!(points.iter().all(reached));
}

/// Of a scene whose usual run takes long the first runs may take as long, and those of the default method come first.
#[test]
fn a_scene_with_long_runs_begins_with_the_default_method() {
    let mut all = [series(Formula::Rk4), series(Formula::Dopri5)];
    all[1].of.switches = true;
    all[1].paces = (1..10).map(|i| Pace::Tolerance(0.1f64.powi(i))).collect();
    for (usual, first) in [(0.0, 0.25), (0.4, 0.6), (2.0, 1.0)] {
        let schedule = Schedule::new(&all, 1.0, 60.0).expecting(usual).on(1);
        let taken = Mutex::new(Vec::new());
        let run = |setting: &Setting, limit: f64| {
            taken.lock().unwrap().push((setting.switches, limit));
            let cost = Cost {
                error: 1e-3 * setting.pace.value(),
                time: 0.3,
            };
            (Status::Failed(String::new()), cost)
        };
        schedule.carry_out(&run, &mut |_| {});
        let taken = taken.into_inner().unwrap();
        assert!((taken[0].1 - first).abs() < 1e-12, "{taken:?}");
        assert!(taken[..6].iter().all(|of| of.0), "{taken:?}");
        assert!(!taken[6].0, "{taken:?}");
    }
}
