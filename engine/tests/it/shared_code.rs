//! Runs of one engine share its machine code.

use bryant_engine::internals::{addresses, has_machine_code};
use bryant_engine::{Engine, Evaluated};
use bryant_generator::Config;
use bryant_runtime::Adjustable;
use std::sync::Barrier;

const SWING: &str = "model: swing
dimension: 2
parameters: { k: 3 }
systems:
  - name: swing
    reference: fixed
    elements: [{ name: arm, mass: 2, cg: [0.3, 0], inertia: k * 0.1 }]
forces: [{ field: gravity, acceleration: [0, -9.81] }]
outputs:
  - { name: angle, of: swing/arm, what: angle }
  - { name: rate, of: swing/arm, what: angular_velocity }
  - { name: rise, of: swing/arm, what: acceleration, component: z }
run: { duration: 1 s, every: 10 ms }
";

fn engine() -> Engine {
    let none = |_: &std::path::Path| Err(std::io::ErrorKind::NotFound.into());
    let (model, _) = bryant_generator::read_str("swing.yaml", SWING, &none).unwrap();
    Engine::new(Config::new().lists(&model)).unwrap()
}

#[test]
fn all_runs_of_an_engine_have_the_same_code_and_each_scalar_its_own() {
    let engine = engine();
    let of_doubles = |wanted: &[usize]| addresses::<f64>(&engine, wanted);
    // kept to the end, so that other code has other addresses
    let (first, _kept) = of_doubles(&[0, 2]);
    assert_eq!(
        first.map(|code| code.is_some()),
        [has_machine_code::<f64>(); 3]
    );
    let (again, _) = of_doubles(&[0, 2]);
    assert_eq!(again, first);
    let elsewhere = std::thread::scope(|scope| {
        let other = scope.spawn(|| of_doubles(&[0, 2]).0);
        other.join().unwrap()
    });
    assert_eq!(elsewhere, first);
    // another scalar, and other outputs
    let (single, _) = addresses::<f32>(&engine, &[0, 2]);
    let (fewer, _) = of_doubles(&[2]);
    if has_machine_code::<f64>() {
        assert!(single.iter().zip(first).all(|(one, other)| *one != other));
        assert_eq!(fewer[..2], first[..2]);
        assert_ne!(fewer[2], first[2]);
    }
}

#[test]
fn runs_beside_each_other_by_the_same_code_do_not_disturb_each_other() {
    let engine = engine();
    let info = engine.info();
    let begin = Barrier::new(4);
    // outputs of a model with this k, of which these are wanted, at many states
    let outputs = |model: &mut dyn Adjustable<f64>, k: f64, wanted: &[usize]| {
        model.set_parameters(&[k]);
        model.want_outputs(wanted);
        let mut all = Vec::new();
        for i in 0..2000 {
            let y = [0.01 * f64::from(i), k];
            let mut outputs = vec![0.0; info.outputs.len()];
            model.outputs(0.0, &y, &mut outputs);
            let mut rate = [0.0; 2];
            model.derivative(0.0, &y, &mut rate);
            all.extend(wanted.iter().map(|&output| outputs[output]));
            all.extend(rate);
        }
        all
    };
    std::thread::scope(|scope| {
        for (k, wanted) in [
            (1.0, vec![0, 2]),
            (2.0, vec![1]),
            (3.0, vec![2]),
            (4.0, vec![0, 1, 2]),
        ] {
            let (engine, begin, outputs) = (&engine, &begin, &outputs);
            scope.spawn(move || {
                begin.wait();
                let mut code: Evaluated<f64> = engine.over();
                let code = outputs(&mut code, k, &wanted);
                let interpreted = outputs(&mut engine.interpreted::<f64>(), k, &wanted);
                assert_eq!(code, interpreted);
            });
        }
    });
}
