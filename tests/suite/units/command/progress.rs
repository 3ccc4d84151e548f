use bryant::command::progress::{State, Whole, span};
use std::time::{Duration, Instant};

#[test]
fn time_left_is_told_in_two_units() {
    assert_eq!(span(3.2), "4 s");
    assert_eq!(span(61.0), "1 min 1 s");
    assert_eq!(span(7260.0), "2 h 1 min");
}

fn state(whole: Whole, from: f64, done: f64) -> State {
    State {
        what: "running seat".into(),
        whole,
        since: Instant::now(),
        from,
        done,
        later: 0.0,
        over: false,
        bar: None,
    }
}

#[test]
fn what_is_done_is_said_in_its_own_unit() {
    let line = |whole, done| state(whole, 0.0, done).line();
    assert_eq!(
        line(Whole::Time(0.12), 0.012),
        "running seat: 12 ms of 120 ms simulated"
    );
    assert_eq!(
        line(Whole::Count(216, "effects"), 34.0),
        "running seat: 34 of 216 effects"
    );
    assert_eq!(line(Whole::Unknown, 0.0), "running seat: 0 s so far");
    assert_eq!(line(Whole::Share, 0.34), "running seat: 34 %");
}

/// An amount that was done at the beginning says nothing about the rate.
#[test]
fn the_time_left_is_that_of_the_rate() {
    let of = state(Whole::Count(100, "runs"), 40.0, 60.0);
    assert_eq!(of.left(Duration::from_secs(10)), Some(20.0));
    assert_eq!(of.left(Duration::from_millis(500)), None);
    let of = State { later: 7.0, ..of };
    assert_eq!(of.left(Duration::from_secs(10)), Some(27.0));
    let of = state(Whole::Time(1.0), 0.0, 0.0);
    assert_eq!(of.left(Duration::from_secs(10)), None);
}
