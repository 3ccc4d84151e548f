use bryant::accuracy::setting::{Pace, Setting};
use bryant::accuracy::target::second_opinion;
use bryant_runtime::Formula;
use bryant_runtime::program::Scalar;

#[test]
fn a_second_opinion_is_another_method() {
    for formula in Formula::ALL {
        let setting = Setting {
            formula,
            switches: false,
            pace: Pace::Tolerance(1e-4),
            scalar: Scalar::F64,
            locate: false,
        };
        let opinion = second_opinion(&setting);
        assert!(opinion.formula != formula && opinion.locate);
        assert_eq!(opinion.pace, Pace::Tolerance(1e-6));
    }
}
