//! Parameters of a job.

use crate::models::Oscillator;
use bryant_runtime::program::{Entry, ErrorKind, JobError};

#[test]
fn parameters_out_of_bounds_are_named_with_their_bounds() {
    let set = |named: &[(String, f64)]| Entry::of::<Oscillator>().model(named).map(|_| ());
    let check =
        |name: &str, value: f64| set(&[(name.to_owned(), value)]).map_err(|error| error.message);
    assert!(check("stiffness", 100.0).is_ok());
    for value in [-1.0, 100.5, f64::NAN, f64::INFINITY] {
        let message = check("stiffness", value).unwrap_err();
        assert!(message.contains("\"stiffness\""), "{message}");
        assert!(message.ends_with("between 0 and 100 N/m"), "{message}");
    }
    assert!(
        check("mass", 1.0)
            .unwrap_err()
            .ends_with("there is stiffness")
    );
    let twice = ["stiffness".to_owned(), "stiffness".to_owned()];
    let error = set(&[(twice[0].clone(), 1.0), (twice[1].clone(), 2.0)]).unwrap_err();
    let [name, _] = twice;
    assert_eq!(error.kind, ErrorKind::Job);
    assert_eq!(
        error.message,
        JobError::RepeatedParameter { name }.to_string()
    );
}
