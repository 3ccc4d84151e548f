//! Nothing of a model stays allocated after its engine: a program of its own, because it counts all memory.

#![expect(
    unsafe_code,
    reason = "an allocator that counts the bytes of the one of the system"
)]

use bryant_engine::Engine;
use bryant_engine::batch::{Rows, Wanted};
use bryant_runtime::batch::{Pace, Settings, rows};
use bryant_runtime::program::{Job, Outcome};
use bryant_runtime::{Dynamics, Formula, Integrator, Tolerances, Width};
use std::alloc::{GlobalAlloc, Layout, System};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes that are allocated now.
static ALLOCATED: AtomicUsize = AtomicUsize::new(0);

struct Counting;

// SAFETY: the allocator of the system does everything; growth by copying, as by default, calls both functions
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATED.fetch_add(layout.size(), Ordering::SeqCst);
        // SAFETY: the caller keeps what the trait asks for
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        ALLOCATED.fetch_sub(layout.size(), Ordering::SeqCst);
        // SAFETY: as above
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// A wheel on a spring with ω = 100 1/s, all of whose names have the number.
fn text(number: u32) -> String {
    format!(
        "\
model: spring-{number:04}
dimension: 2
parameters: {{ inertia_{number:04}: {{ value: 1, min: 0.1, max: 10 }} }}
inputs: {{ push_{number:04}: {{ value: 0 N*m, min: -1 N*m, max: 1 N*m }} }}
curves: {{ line_{number:04}: {{ points: [[-1, -10000], [1, 10000]], extrapolate: linear }} }}
systems:
  - name: wheel_{number:04}
    reference: fixed
    elements: [{{ name: body, mass: 1, cg: [0, 0], inertia: inertia_{number:04} }}]
    start: {{ rates: {{ body: 1 }} }}
forces:
  - {{ joint: wheel_{number:04}/body, elastic: line_{number:04} }}
  - {{ joint: wheel_{number:04}/body, name: drive, motor: push_{number:04} }}
outputs: [{{ name: angle_{number:04}, of: joint wheel_{number:04}/body, what: angle }}]
run: {{ duration: 0.6 s, every: 0.1 s }}
"
    )
}

/// Derives a model, runs it in all ways, and drops it.
fn pass(number: u32) {
    let name = format!("wheel_{number:04}/body");
    let engine = Engine::of_text("spring.yaml", &text(number)).unwrap();
    let engine = Engine::of_kept(&engine.keep()).unwrap();
    let run = |job: &Job| -> Outcome {
        let go_on = |_: f64| ControlFlow::Continue(());
        let mut samples = 0;
        let mut count = |_: f64, _: &[f64], _: &[f64]| {
            samples += 1;
            ControlFlow::Continue(())
        };
        engine.run(job, &mut count, &mut { go_on })
    };

    let outcome = run(&Job::default());
    assert!(outcome.result.is_ok() && outcome.doubts.is_empty());
    // Runge and Kutta's method is stable up to ω h = 2.83
    let too_long = |step| Job {
        method: Some(Integrator::fixed(Formula::Rk4, step)),
        ..Job::default()
    };
    let doubtful = run(&too_long(0.03));
    assert!(doubtful.result.is_ok());
    assert!(doubtful.doubts[0].message.contains(&name));
    let failed = run(&Job {
        duration: Some(600.0),
        every: Some(60.0),
        ..too_long(1.0)
    });
    let error = failed.result.expect_err("no step of 1 s is stable");
    assert!(error.message.contains(&name) && error.cause.contains(&name));
    assert!(!failed.doubts.is_empty());
    let unknown = Job {
        parameters: vec![("mass".to_owned(), 1.0)],
        ..Job::default()
    };
    let error = run(&unknown).result.expect_err("no such parameter");
    assert!(error.message.contains(&format!("inertia_{number:04}")));

    let mut batch = engine.batch(1);
    let at = Rows {
        coordinates: &[0.1, 0.2],
        velocities: &[0.0, 0.0],
        inputs: &[0.5, 2.0],
        ..Rows::default()
    };
    let refused = batch.evaluate(Wanted::Accelerations, &at, &mut [0.0; 2]);
    let refused = refused.expect_err("an input is above its limit");
    assert!(refused.to_string().contains(&format!("push_{number:04}")));
    let lanes = rows::Job {
        settings: Settings {
            duration: 0.1,
            samples: 2,
            pace: Pace::Adaptive(Tolerances::default()),
            locate: true,
            max_steps: 1000,
            time_limit: None,
            energy_limit: 0.02,
        },
        varied: vec![0],
        fixed: Vec::new(),
        responses: Vec::new(),
        estimate: false,
        wanted: f64::INFINITY,
        width: Width::widest(),
    };
    assert_eq!(engine.rows(&lanes, &[1.0, 2.0, 3.0]).unwrap().rows.len(), 3);

    // a model over one scalar keeps its facts, and needs no engine
    let model = engine.over::<f64>();
    drop((batch, engine));
    assert!(model.info().coordinates[0].starts_with(&name));
    assert_eq!(model.info().outputs[0].name, format!("angle_{number:04}"));
}

#[test]
fn nothing_of_a_model_stays_allocated() {
    // what is made once for all models
    for number in 0..3 {
        pass(number);
    }
    let before = ALLOCATED.load(Ordering::SeqCst);
    for number in 3..300 {
        pass(number);
        assert_eq!(
            ALLOCATED.load(Ordering::SeqCst),
            before,
            "after the model {number}"
        );
    }
}
