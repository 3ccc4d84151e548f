use bryant_generator::description::expression::{
    Expression, ExpressionKind, Function, Operator, parse,
};

/// Value in SI with all parameters 3.
fn value(e: &Expression) -> f64 {
    match &e.kind {
        ExpressionKind::Number(v) => *v,
        ExpressionKind::Quantity(v, unit) => v * unit.factor,
        ExpressionKind::Parameter(_) => 3.0,
        ExpressionKind::Negative(a) => -value(a),
        ExpressionKind::Binary(Operator::Add, a, b) => value(a) + value(b),
        ExpressionKind::Binary(Operator::Subtract, a, b) => value(a) - value(b),
        ExpressionKind::Binary(Operator::Multiply, a, b) => value(a) * value(b),
        ExpressionKind::Binary(Operator::Divide, a, b) => value(a) / value(b),
        ExpressionKind::Call(Function::SquareRoot, a) => value(a).sqrt(),
        ExpressionKind::Call(Function::Sine, a) => value(a).sin(),
        ExpressionKind::Call(Function::Cosine, a) => value(a).cos(),
    }
}

#[test]
fn arithmetic_follows_the_usual_ranks() {
    for (text, expected) in [
        ("2 + 3*4", 14.0),
        ("2*-k", -6.0),
        ("-(k - 1)/2", -1.0),
        ("8/2/2", 2.0),
        ("7 - 2 - 1", 4.0),
        ("sqrt(k*k) + cos(0)", 4.0),
        ("1e2", 100.0),
        ("pi/pi", 1.0),
        ("60 kN", 60e3),
        ("1e5 N/m", 1e5),
        ("36 km/h", 10.0),
        ("6 / 2 N/m", 3.0),
        ("6 * k / 2 s^-1", 9.0),
        ("9.80665 m/s^2 / 1 gn", 1.0),
        ("5 m·s^-2", 5.0),
        ("4 m²", 4.0),
        ("20%", 0.2),
        ("1/ms", 1000.0),
    ] {
        let parsed = parse(text).unwrap_or_else(|m| panic!("{text}: {m:?}"));
        let found = value(&parsed);
        assert!(
            (found - expected).abs() <= 4.0 * f64::EPSILON * expected.abs(),
            "{text}: {found}"
        );
    }
}

#[test]
fn degrees_are_radians() {
    assert_eq!(value(&parse("180 deg").unwrap()), std::f64::consts::PI);
    assert_eq!(value(&parse("180°").unwrap()), std::f64::consts::PI);
}

#[test]
fn mistakes_are_placed() {
    for (text, offset, part) in [
        ("60 kn", 3, "did you mean `kN`"),
        ("2 stiffness", 2, "write `2 * stiffness`"),
        ("2 kg m^2", 5, "joined by"),
        ("(1 + 2", 0, "add `)`"),
        ("1 +", 2, "write a number"),
        ("k^2", 1, "a * a"),
        ("1 $ 2", 2, "made of numbers"),
        ("tan(1)", 0, "sqrt, sin and cos"),
        ("1.2.3", 0, "numbers are written like"),
        ("m^1.5", 2, "m/s^2"),
        ("", 0, "write a number"),
    ] {
        let mistake = parse(text).expect_err(text);
        assert_eq!(mistake.offset, offset, "{text}");
        assert!(mistake.help.contains(part), "{text}: {}", mistake.help);
    }
}

#[test]
fn nesting_and_length_are_limited() {
    assert!(parse(&"(".repeat(900)).is_err());
    assert!(parse(&"-".repeat(900)).is_err());
    assert!(parse(&"1+".repeat(90_000)).is_err());
}
