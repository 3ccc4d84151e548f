//! Powers with their derivatives.

use bryant_runtime::Dual;
use bryant_runtime::force::power::power;

#[test]
fn powers_have_the_slopes_of_both_arguments() {
    let constant = Dual::<f64>::constant;
    // d(2^x)/dx = 2^x ln 2,  d(x^3)/dx = 3 x^2
    let by_exponent = power(constant(2.0), Dual::variable(3.0));
    let by_base = power(Dual::variable(2.0), constant(3.0));
    assert_eq!((by_exponent.value, by_base.value), (8.0, 8.0));
    assert!((by_exponent.slope - 8.0 * 2.0_f64.ln()).abs() < 16.0 * f64::EPSILON);
    assert!((by_base.slope - 12.0).abs() < 16.0 * f64::EPSILON);
    assert!(power(f64::NAN, 2.0).is_nan());
}
