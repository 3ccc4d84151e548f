//! The methods that every model has.

use crate::models::{Oscillator, Pendulum};
use crate::scalars::Pair;
use bryant_runtime::Dual;
use bryant_runtime::model::{Model, OffsetView, OutputWriter, ParameterSet, TailView, over};

#[test]
fn a_sink_is_a_part_of_another() {
    let mut all = [0; 5];
    let mut end = OffsetView::<_, 3>(&mut all);
    end.put(0, 30);
    end.put(1, 40);
    assert_eq!(all, [0, 0, 0, 30, 40]);
    let mut end = [0; 2];
    let mut all = TailView::<_, 3>(&mut end);
    for index in 0..5 {
        all.put(index, 10 * index);
    }
    assert_eq!(end, [30, 40]);
}

#[test]
fn the_same_model_over_dual_numbers_gives_the_jacobian() {
    let mut parameters = <Oscillator as ParameterSet<f64>>::defaults();
    assert!(parameters.set(0, 7.0));
    let model = <Oscillator as Model<f64>>::new(parameters);
    let constant = Dual::constant;
    let dual = over(&model, constant);
    let along = |slope: [f64; 2]| {
        let value = [0.25, 3.0];
        let y = [0, 1].map(|i| Dual {
            value: value[i],
            slope: slope[i],
        });
        dual.derivative(constant(0.0), &y).map(|rate| rate.slope)
    };
    // ẋ = v, v̇ = −7 x
    assert_eq!(
        [along([1.0, 0.0]), along([0.0, 1.0])],
        [[0.0, -7.0], [1.0, 0.0]]
    );
    // parameters may differ by lane, and by a derivative
    let lanes = over(&model, |k| Pair([k, 2.0 * k]));
    let rate = lanes.derivative(Pair([0.0; 2]), &[Pair([1.0; 2]), Pair([0.0; 2])]);
    assert_eq!(rate[1], Pair([-7.0, -14.0]));
}

#[test]
fn a_model_without_parameters_is_the_same_over_every_scalar() {
    let model = <Pendulum as Model<f64>>::new(crate::models::None);
    let start: [f32; 2] = over::<f64, f32, _>(&model, |x| x as f32).initial_state();
    assert_eq!(start, [core::f32::consts::FRAC_PI_2, 0.0]);
}
