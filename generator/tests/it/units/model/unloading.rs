use bryant_generator::model::unloading::{ROUNDING, above, clearances, steepest, value};
use bryant_generator::model::{Curve, Extrapolate, Interpolate, Number, ScaledCurve};

fn curve(points: &[[f64; 2]], extrapolate: Extrapolate) -> Curve {
    let (name, points) = (String::new(), points.to_vec());
    Curve {
        name,
        points,
        interpolate: Interpolate::Linear,
        extrapolate,
        states_extrapolation: true,
        thinned: None,
    }
}

/// Whether u, scaled, keeps at or below f.
fn below(u: (&Curve, f64), f: (&Curve, f64)) -> bool {
    let scaled = |times: f64| ScaledCurve {
        curve: 0,
        times: times.into(),
        stretch: Number::Constant(1.0),
        stiffness: false,
    };
    let pairs = above((u.0, &scaled(u.1)), (f.0, &scaled(f.1)));
    pairs.iter().all(|[a, b]| a * f.1 >= b * u.1)
}

#[test]
fn curves_are_compared_wherever_either_has_a_kink() {
    let f = curve(&[[0.0, 0.0], [2.0, 2.0]], Extrapolate::Linear);
    let u = curve(&[[0.0, 0.0], [1.0, 0.2], [1.5, 1.4]], Extrapolate::Hold);
    assert!(below((&u, 1.0), (&f, 1.0)));
    // 1.2 · 1.4 = 1.68 at 1.5
    assert!(!below((&u, 1.2), (&f, 1.0)));
    assert!(below((&u, 1.2), (&f, 1.2)));
    // held at 2 while the other goes on with 2.4 per unit
    let u = curve(&[[0.0, 0.0], [1.5, 1.4], [1.6, 1.6]], Extrapolate::Linear);
    assert!(!below((&u, 1.0), (&f, 1.0)));
    let u = curve(&[[1.9, 0.0], [2.0, 0.2]], Extrapolate::Linear);
    assert!(!below((&u, 1.0), (&f, 1.0)));
}

#[test]
fn few_inequalities_are_left_of_many() {
    let parabola = |k: f64| [k, k * k];
    let f: Vec<[f64; 2]> = (0..50).map(|k| parabola(f64::from(k))).collect();
    let u: Vec<[f64; 2]> = f.iter().map(|[x, y]| [*x, 0.5 * y]).collect();
    let [f, u] = [f, u].map(|points| curve(&points, Extrapolate::Hold));
    let one = ScaledCurve {
        curve: 0,
        times: 1.0.into(),
        stretch: 1.0.into(),
        stiffness: false,
    };
    let pairs = above((&u, &one), (&f, &one));
    assert!(pairs.len() <= 3, "{pairs:?}");
    assert!(below((&u, 2.0), (&f, 1.0)));
    assert!(!below((&u, 2.000001), (&f, 1.0)));
    assert!(!below((&u, 1.0), (&f, -1.0)));
}

#[test]
fn curves_that_parameters_stretch_are_compared_as_they_then_are() {
    let f = curve(&[[0.0, 0.0], [1.0, 1.0], [2.0, 4.0]], Extrapolate::Linear);
    let u = curve(&[[0.0, 0.0], [1.0, 0.5], [2.0, 1.0]], Extrapolate::Hold);
    let scaled = |stretch: Number| ScaledCurve {
        curve: 0,
        times: 1.0.into(),
        stretch,
        stiffness: false,
    };
    let found = |stretch: f64, by: Number| {
        let clear = clearances((&u, &scaled(by)), (&f, &scaled(1.0.into())));
        clear.iter().all(|number| number.value(&[stretch]) >= 0.0)
    };
    for (stretch, keeps) in [(1.0, true), (0.5, true), (0.49, false), (3.0, true)] {
        assert_eq!(found(stretch, Number::Parameter(0)), keeps, "{stretch}");
        assert_eq!(found(stretch, stretch.into()), keeps, "{stretch}, constant");
    }
}

#[test]
fn the_steepest_slopes_are_up_and_down() {
    let f = curve(&[[0.0, 0.0], [2.0, 2.0], [3.0, -1.0]], Extrapolate::Hold);
    let close = |a: f64, b: f64| (a - b).abs() <= 2.0 * ROUNDING * b.abs();
    let slopes = steepest(&f);
    assert!(close(slopes[0], 1.0) && close(slopes[1], -3.0));
}

#[test]
fn a_held_curve_keeps_its_outermost_value() {
    let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Hold);
    assert_eq!(
        [0.0, 1.5, 2.0, 9.0].map(|x| value(&f, x)),
        [1.0, 2.0, 3.0, 3.0]
    );
    let f = curve(&[[1.0, 1.0], [2.0, 3.0]], Extrapolate::Linear);
    assert_eq!([0.0, 3.0].map(|x| value(&f, x)), [-1.0, 5.0]);
}
