use bryant_generator::program::breakpoints::passed;

#[test]
fn a_point_is_passed_when_the_abscissa_reaches_it() {
    for rate in [1.0, 0.1, 1.0 / 3.0, 1.0 / 0.7, 12.9] {
        for x in [-0.3, 0.0, 1e-3, 0.1, 0.7, 5.0] {
            let t = passed(x, rate);
            assert!(
                t * rate >= x && t.next_down() * rate < x,
                "{x}, {rate}: {t}"
            );
        }
    }
}
