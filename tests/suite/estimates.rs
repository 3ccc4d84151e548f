//! The error that a run estimates for itself, against the true error, in a thousand random scenes.

use crate::share::share;
use bryant::accuracy::difference::Difference;
use bryant::accuracy::target;
use bryant::build_on_demand::UserForces;
use bryant::equations::{self, Engine};
use bryant::{bundled, simulation};
use bryant_generator::law::ForceKind;
use bryant_generator::model::Model;
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};
use std::sync::Arc;

/// The models, with their numbers of scenes: bundled models with contacts, belts, joints with stops, switches and
/// states of force laws. Parameters are drawn from their whole bounds, or from half to twice their defaults.
const SCENES: [(&str, usize); 3] = [("sled-pendulum", 600), ("elbow", 300), ("child-seat", 100)];
/// The promise of a run without options for every output.
const PROMISED: f64 = 1e-3;
/// The requested accuracies, in turn.
const WANTED: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// A number in 0..1 (splitmix64).
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *seed;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// The equations of a bundled model, with the functions of its user forces compiled.
pub fn engine_of(model: &Model) -> Engine {
    let sources = model
        .forces
        .iter()
        .filter_map(|force| match ForceKind::of(force) {
            ForceKind::User(user) => {
                let source = user.function.source.as_ref()?;
                Some((source.name.clone(), source.text.clone()))
            }
            _ => None,
        });
    let users = UserForces::of(model, sources.collect(), &mut |_| {}).expect("they compile");
    equations::with_users(model, users.map(Arc::new)).expect("nothing is missing")
}

#[test]
fn the_estimate_covers_the_true_error_in_95_of_100_scenes() {
    let (mut covered, mut reached, mut kept, mut scenes) = (0u32, 0u32, 0u32, 0u32);
    let mut worst = Vec::new();
    for (name, count) in SCENES {
        let bundled = bundled::find(name).expect("a bundled model");
        let model = bundled::model(bundled).expect("bundled models are right");
        let engine = engine_of(&model);
        let info = engine.info();
        for scene in share(5, 0..count) {
            // the same parameters, whatever other scenes are tried
            let mut seed = 1000 * name.len() as u64 + scene as u64;
            let parameters = info.parameters.iter().map(|p| {
                let low = if p.min.is_finite() {
                    p.min.max(0.5 * p.default)
                } else {
                    0.5 * p.default
                };
                let high = if p.max.is_finite() {
                    p.max.min(2.0 * p.default)
                } else {
                    2.0 * p.default
                };
                let (low, high) = (low.min(high), low.max(high));
                (p.name.to_owned(), low + (high - low) * random(&mut seed))
            });
            let job = Job {
                parameters: parameters.collect(),
                every: Some(info.duration / 40.0),
                ..Job::default()
            };
            let wanted = WANTED[scene % WANTED.len()];
            let run = target::run(&engine, &job, wanted, &mut |_| {});
            let default = simulation::run(&engine, &job, &mut |_| {});
            let sharp = Job {
                method: Some(Integrator::adaptive(Formula::Dop853, Tolerances::of(1e-11))),
                locate: Some(true),
                ..job
            };
            let sharp = simulation::run(&engine, &sharp, &mut |_| {});
            assert!(sharp.result.is_ok(), "{name} {scene}: {:?}", sharp.result);
            let error = Difference::of(&run.recording.table, &sharp.table);
            let estimate = run
                .certainty
                .estimate
                .map_or(f64::INFINITY, |estimate| estimate.worst);
            scenes += 1;
            kept += u32::from(Difference::of(&default.table, &sharp.table).worst <= PROMISED);
            reached += u32::from(error.worst <= wanted);
            if error.worst <= estimate {
                covered += 1;
            } else {
                worst.push((name, scene, wanted, estimate, error.worst, error.output));
            }
        }
    }
    // of a random part of the scenes, less by three standard deviations of its number at most
    let least = |share: f64| {
        let count = f64::from(scenes);
        let scatter = if scenes < 1000 {
            (count * share * (1.0 - share)).sqrt()
        } else {
            0.0
        };
        count * share - 3.0 * scatter
    };
    assert!(scenes >= 200);
    assert!(
        f64::from(covered) >= least(0.95),
        "{covered} of {scenes}: {worst:?}"
    );
    // the requested accuracy is reached, too
    assert!(f64::from(reached) >= least(0.95), "{reached} of {scenes}");
    // and so is the default promise
    assert!(f64::from(kept) >= least(0.99), "{kept} of {scenes}");
}
