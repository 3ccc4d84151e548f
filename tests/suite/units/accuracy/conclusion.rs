use bryant::accuracy::conclusion::percent;
use bryant::accuracy::setting::{time, two_digits};

#[test]
fn accuracies_are_written_as_people_do() {
    assert_eq!(percent(1e-2), "1 %");
    assert_eq!(percent(2.5e-4), "0.025 %");
    assert_eq!(percent(1e-6), "1e-6");
    assert_eq!(time(two_digits(2.148e-4)), "210 µs");
}
