use bryant::accuracy::check::opinion;
use bryant::accuracy::setting::{Pace, Setting};
use bryant_runtime::Formula;
use bryant_runtime::program::Scalar;

#[test]
fn a_check_is_by_another_formula_and_sharper() {
    for formula in Formula::ALL {
        for pace in [
            Pace::Tolerance(1e-3),
            Pace::Tolerance(1e-9),
            Pace::Step(1e-4),
        ] {
            let setting = Setting {
                formula,
                switches: false,
                pace,
                scalar: Scalar::F64,
                locate: false,
            };
            let check = opinion(&setting);
            assert_ne!(check.formula, formula);
            if let Pace::Tolerance(tolerance) = pace {
                assert!(check.pace.value() < 0.11 * tolerance);
            }
        }
    }
}
