use bryant::simulation::{MOST_INSTANTS, Recorder, Turning};
use bryant_runtime::program::{Header, Outcome, RunError};
use std::time::Duration;

fn header() -> Header {
    Header {
        name: "pendulum".into(),
        digest: String::new(),
        dimension: 2,
        coordinates: vec!["a/b.phi".into()],
        velocities: vec!["a/b.omega".into()],
        auxiliaries: vec![],
        memory: vec![],
        event_functions: vec![],
        kinks: vec![],
        powers: vec![],
        outputs: Vec::new(),
        parameters: Vec::new(),
        duration: 1.0,
        every: 0.1,
    }
}

#[test]
fn a_long_run_keeps_few_poses_but_the_first_and_the_last() {
    let turning = Turning {
        systems: Vec::new(),
        fastest: 0.0,
    };
    let mut recorder = Recorder::new(header(), turning, MOST_INSTANTS);
    let samples = 10 * MOST_INSTANTS + 7;
    for i in 0..samples {
        recorder.add(i as f64, &[i as f64, 0.0], &[]);
    }
    let error = RunError {
        kind: bryant_runtime::program::ErrorKind::Run,
        t: None,
        coordinate: None,
        cause: String::new(),
        message: "broke off".into(),
    };
    let recording = recorder.finish(
        Outcome {
            result: Err(error),
            answers: vec![],
            kept: vec![],
            history: None,
            energy: None,
            doubts: vec![],
            notes: vec![],
            nearest: vec![],
        },
        Duration::ZERO,
    );
    let last = (samples - 1) as f64;
    assert!(recording.instants.len() <= MOST_INSTANTS + 1);
    assert_eq!(recording.instants[0].time, 0.0);
    assert_eq!(recording.last_time(), last);
    let ends = recording.at(&[0.0, 100.2, last, last + 1.0]);
    let times: Vec<f64> = ends.iter().map(|i| i.time).collect();
    assert_eq!((times[0], times[2], times.len()), (0.0, last, 3));
    assert!(ends.iter().all(|i| i.coordinates == [i.time]));
    // Poses are one stride apart, so the nearest is at most half a stride away.
    assert!((times[1] - 100.2).abs() <= recorder_stride(samples) as f64 / 2.0);
}

/// Number of samples between two poses after a run of this many samples.
fn recorder_stride(samples: usize) -> usize {
    samples.div_ceil(MOST_INSTANTS).next_power_of_two()
}
