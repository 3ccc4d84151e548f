use bryant_generator::model::Rule;
use bryant_generator::model::rule::Key;

#[test]
fn what_is_not_finite_keeps_no_rule() {
    let rules = [
        Rule::Finite,
        Rule::NotZero,
        Rule::NotNegative,
        Rule::Positive,
    ];
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(rules.map(|rule| rule.keeps(value)), [false; 4]);
    }
    assert_eq!(
        rules.map(|rule| rule.keeps(-1.0)),
        [true, true, false, false]
    );
    assert_eq!(
        rules.map(|rule| rule.keeps(-0.0)),
        [true, false, true, false]
    );
    assert_eq!(rules.map(|rule| rule.keeps(5e-324)), [true; 4]);
}

#[test]
fn a_number_is_found_from_its_term() {
    let beside = Key::Beside("friction_speed".into());
    assert_eq!(beside.path("about.x.friction"), "about.x.friction_speed");
    assert_eq!(beside.path("friction"), "friction_speed");
    assert_eq!(Key::Below("from".into()).path("stop"), "stop.from");
    assert_eq!(Key::Item(1).path("plane.extent"), "plane.extent[1]");
}
