use bryant::accuracy::point::Known;
use bryant::accuracy::report::front::{digits, known};

#[test]
fn numbers_have_three_digits() {
    assert_eq!(
        [0.21456, 21.456, 2145.6].map(digits),
        ["0.215", "21.5", "2146"]
    );
    let bound = |at_most| {
        known(Known {
            error: 1.23e-10,
            at_most,
        })
    };
    assert_eq!([bound(true), bound(false)], ["≤1.2e-10", "1.2e-10"]);
}
