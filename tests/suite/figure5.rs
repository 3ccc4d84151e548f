//! The child of the 1980 paper in its seat: the table of figure 5, and free flight where nothing holds it.

use bryant::bundled::find;
use bryant::{equations, simulation};
use bryant_generator::law::ForceKind;
use bryant_generator::model::{Curve, Model, Quantity};
use bryant_runtime::program::Job;
use bryant_runtime::{Formula, Integrator, Tolerances};
use bryant_tests::runs::run;

const TOLERANCE: f64 = 1e-10;

/// The table of figure 5: time \[ms\], lap belt and contact 2 \[N\], head acceleration \[m/s²\], head excursion \[m\],
/// as printed.
const FIGURE_5: [[f64; 5]; 16] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0, 0.0, 0.0],
    [4.0, 0.0, 0.0, 0.0, 0.0],
    [6.0, 0.0, 0.0, 0.0, 0.0],
    [8.0, 0.0, 0.0, 0.0, 0.0],
    [10.0, 0.0, 0.0, 0.0, 0.0],
    [12.0, 0.0, 1.0, 40.0, 0.0],
    [14.0, 0.0, 5.0, 80.0, 0.0],
    [16.0, 1.0, 12.0, 118.0, 0.001],
    [18.0, 3.0, 21.0, 158.0, 0.002],
    [20.0, 7.0, 34.0, 198.0, 0.003],
    [22.0, 12.0, 49.0, 195.0, 0.006],
    [24.0, 19.0, 66.0, 197.0, 0.009],
    [26.0, 29.0, 83.0, 194.0, 0.013],
    [28.0, 38.0, 105.0, 191.0, 0.018],
    [30.0, 47.0, 183.0, 190.0, 0.023],
];

#[test]
fn the_table_of_figure_5_is_met_in_all_four_columns() {
    let seat = bryant_generated::find("child-seat").expect("a bundled model");
    let ride = run(&seat.entry, &[], TOLERANCE);
    let names = [
        "lap belt force",
        "cushion force",
        "res. head acceleration",
        "head excursion",
    ];
    let columns = names.map(|name| ride.column(name));
    for printed in FIGURE_5 {
        let row = ride.at(1e-3 * printed[0]);
        let [lap, contact, acceleration, excursion] = columns.each_ref().map(|column| column[row]);
        for (force, printed) in [(lap, printed[1]), (contact, printed[2])] {
            let apart = (force - printed).abs();
            // what the paper prints is known to half a newton; the fit to 2 N or 3 %
            let bound = 2f64.max(0.03 * printed);
            assert!(apart <= bound, "{printed:?}: {force} instead of {printed}");
        }
        assert_eq!(acceleration.round(), printed[3], "{printed:?}");
        assert_eq!((1e3 * excursion).round(), 1e3 * printed[4], "{printed:?}");
    }
}

/// A curve of time whose pieces are straight, and its double integral from a start at rest.
fn field_and_way(curve: &Curve, t: f64) -> [f64; 2] {
    let [mut field, mut v, mut x] = [0.0; 3];
    for pair in curve.points.windows(2) {
        let ([from, a], [to, b]) = (pair[0], pair[1]);
        let h = t.min(to) - from;
        if h < 0.0 {
            break;
        }
        let slope = (b - a) / (to - from);
        x += v * h + (a / 2.0 + slope * h / 6.0) * h * h;
        v += (a + slope * h / 2.0) * h;
        field = a + slope * h;
    }
    [field, x]
}

/// The child without belts and contacts: only the fields act, equally on all elements, and each of them moves as a
/// point does.
fn floating() -> Model {
    let bundled = find("child-seat").expect("a bundled model");
    let mut model = bryant::bundled::model(bundled).expect("the model reads");
    let holds = |kind: ForceKind| matches!(kind, ForceKind::Belt(_) | ForceKind::Contact(_));
    model.forces.retain(|force| !holds(ForceKind::of(force)));
    model
        .outputs
        .retain(|output| matches!(output.quantity, Quantity::Point { .. }));
    model.digest.clear();
    model
}

#[test]
fn a_child_that_nothing_holds_floats_as_a_point_does() {
    let model = floating();
    let pulse = model.curves.iter().find(|curve| curve.name == "pulse");
    let pulse = pulse.expect("the field has a curve");
    let engine = equations::of(&model).expect("the model has equations");
    for gravity in [0.0, 9.81] {
        let job = Job {
            method: Some(Integrator::adaptive(
                Formula::Dopri5,
                Tolerances::uniform(TOLERANCE),
            )),
            duration: Some(0.03),
            parameters: vec![("gravity".to_owned(), gravity)],
            ..Job::default()
        };
        let ride = simulation::run(&engine, &job, &mut |_| {});
        let report = ride.result.as_ref().expect("the run ends well");
        let column = |name: &str| {
            let found = ride.table.columns.iter().find(|column| column.name == name);
            &found.expect("an output").values
        };
        let [acceleration, excursion, accelerometer] = [
            "res. head acceleration",
            "head excursion",
            "head accelerometer",
        ]
        .map(column);
        // each step errs by the tolerance, or by less for a polynomial of degree 3: rounding remains
        let bound = report.steps as f64 * TOLERANCE;
        for (row, &t) in column("time").iter().enumerate() {
            let [field, x] = field_and_way(pulse, t);
            assert!((excursion[row] - x).abs() <= bound, "excursion at {t} s");
            let a = field.hypot(gravity);
            assert!(
                (acceleration[row] - a).abs() <= 1e-9 * 198.0,
                "acceleration at {t} s"
            );
            assert!(
                accelerometer[row].abs() <= 1e-9 * 198.0,
                "accelerometer at {t} s"
            );
        }
    }
}
