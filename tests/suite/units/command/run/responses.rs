use bryant::command::run::responses::digits;

#[test]
fn values_have_four_digits() {
    assert_eq!(digits(0.0), "0");
    assert_eq!(digits(559.812), "559.8");
    assert_eq!(digits(-0.0123456), "-0.01235");
    assert_eq!(digits(123456.7), "123457");
    assert_eq!(digits(1.23456e-9), "1.235e-9");
}
