use bryant::command::gradient::table::{known_digits, number, quotient};
use bryant_generator::model::units::UnitSystem;

#[test]
fn numbers_have_as_many_digits_as_are_known() {
    assert_eq!(number(1234.5678, 7), "1234.568");
    assert_eq!(number(1234.5678, 2), "1235");
    assert_eq!(number(-0.25, 5), "-0.25000");
    assert_eq!(number(1e-9, 3), "1.00e-9");
    assert_eq!(known_digits(2.0, None), 5);
    assert_eq!(known_digits(2.0, Some(0.0)), 5);
    assert_eq!(known_digits(2.0, Some(1e-3)), 3);
    assert_eq!(known_digits(2.0, Some(1e-9)), 5);
    // what is smaller than the error
    assert_eq!(known_digits(1e-6, Some(1e-3)), 1);
    assert_eq!(known_digits(2.0, Some(f64::NAN)), 5);
}

#[test]
fn units_of_slopes_are_quotients() {
    let of = |system: UnitSystem, above: &str, below: &str| {
        quotient(&system.unit(above), &system.unit(below))
    };
    for (above, below, si, engineering) in [
        ("N", "m", "N/m", "kN/mm"),
        ("N", "N", "", ""),
        ("", "m", "1/m", "1/mm"),
        ("m/s^2", "", "m/s^2", "g"),
        ("N", "N/m", "m", "kN/(N/m)"),
        ("N*m", "", "N*m", "N*m"),
    ] {
        assert_eq!(of(UnitSystem::Si, above, below), si);
        assert_eq!(of(UnitSystem::Engineering, above, below), engineering);
    }
}
