//! Every bundled model is there, and starts. These tests are apart from the library, which is long to compile and so is
//! compiled once.

use bryant_generated::{MODELS, find};
use bryant_runtime::program::RunError;

#[test]
fn every_model_is_found_by_its_name_and_has_its_text() {
    assert!(!MODELS.is_empty());
    for model in MODELS {
        let found = find(model.entry.info.name).map(|found| found.entry.info.name);
        assert_eq!(found, Some(model.entry.info.name));
        assert!(
            model
                .yaml()
                .contains(&format!("model: {}", model.entry.info.name))
        );
    }
}

#[test]
fn every_model_starts_with_finite_rates() -> Result<(), RunError> {
    for model in MODELS {
        let state = model.entry.initial_state(&[])?;
        let mut rates = vec![f64::NAN; state.len()];
        model.entry.derivative(&[], 0.0, &state, &mut rates)?;
        assert!(
            rates.iter().all(|rate| rate.is_finite()),
            "{}: {rates:?}",
            model.entry.info.name
        );
    }
    Ok(())
}
