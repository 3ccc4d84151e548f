use bryant::picture::work_precision::{Diagram, FRAME, Line, place, power};

pub fn diagram() -> Diagram {
    let line = |method, variant, fixed, points: &[[f64; 2]]| Line {
        method,
        variant,
        fixed,
        points: points.to_vec(),
    };
    Diagram {
        title: "pendulum <10 s>".into(),
        error: "the state".into(),
        methods: vec!["rk4".into(), "dop853".into()],
        variants: vec!["f64".into(), "f32".into()],
        lines: vec![
            line(0, 0, true, &[[1e-2, 1e-4], [1e-6, 1e-3]]),
            line(
                1,
                0,
                false,
                &[[1e-3, 5e-5], [1e-9, 2e-4], [f64::INFINITY, 1.0]],
            ),
            line(1, 1, false, &[[1e-3, 4e-5]]),
        ],
        front: vec![[1e-3, 4e-5], [1e-9, 2e-4]],
        own: 1e-13,
        sentence: "for 1 % in the state the cheapest is dop853".into(),
    }
}

#[test]
fn lines_points_legend_and_sentence_are_there() {
    let svg = diagram().drawing().svg();
    let count = |text: &str| svg.matches(text).count();
    // two lines of more than one point, a sample of each in the legend
    assert_eq!(count("<polyline class=\"line"), 2 + 2, "{svg}");
    assert_eq!(count("<polyline class=\"front\""), 2);
    // rings around the front, and one in the legend
    assert_eq!(count("<circle class=\"ring\""), 2 + 1);
    // f32 is a little faster at one error, f64 reaches all
    assert_eq!(diagram().best(), [Some(0), Some(1)]);
    assert_eq!(
        (count("class=\"mark f1\""), count("class=\"mark grey\"")),
        (2, 1 + 2)
    );
    assert_eq!(count("class=\"other\""), 1);
    for text in [
        "pendulum &lt;10 s&gt;",
        "10⁻⁹",
        "100 µs",
        "for 1 %",
        "rk4",
        "dop853, f64",
        "their other variants",
    ] {
        assert!(svg.contains(text), "{text}: {svg}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    assert_eq!(svg, diagram().drawing().svg());
}

#[test]
fn places_are_logarithmic() {
    let axes = diagram().axes();
    let [left, top, width, height] = FRAME;
    assert_eq!(axes.ranges, [-9.0..-2.0, -4.5..-3.0]);
    let corner = place(&axes, [1e-9, 1e-3]);
    assert!((corner[0] - left).abs() < 1e-9 && (corner[1] - top).abs() < 1e-9);
    let middle = place(&axes, [10f64.powf(-5.5), 10f64.powf(-3.75)]);
    assert!((middle[0] - left - 0.5 * width).abs() < 1e-9);
    assert!((middle[1] - top - 0.5 * height).abs() < 1e-9);
}

#[test]
fn a_study_without_a_single_point_is_drawn_too() {
    let empty = Diagram {
        lines: Vec::new(),
        front: Vec::new(),
        ..diagram()
    };
    assert!(empty.drawing().svg().ends_with("</svg>\n"));
}

#[test]
fn powers_of_ten_are_written_as_people_do() {
    assert_eq!([power(-12), power(0), power(3)], ["10⁻¹²", "1", "10³"]);
}
