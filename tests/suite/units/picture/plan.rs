use bryant::picture::plan::{enough, tick};

#[test]
fn an_axis_has_three_ticks_where_they_fit() {
    let ends = [-0.07, 0.3];
    assert_eq!(enough(0.05, ends, |_| true), 0.05);
    // 0 and 0.2 are only two; 0, 0.1, 0.2, 0.3 are enough
    assert!((enough(0.2, ends, |_| true) - 0.1).abs() < 1e-12);
    assert!((enough(0.5, ends, |_| true) - 0.1).abs() < 1e-12);
    assert_eq!(enough(0.5, ends, |step| step > 0.1), 0.2);
    assert_eq!(tick(0.1, 0.30000000000000004), "0.3");
    assert_eq!(tick(20.0, -40.0), "−40");
}
