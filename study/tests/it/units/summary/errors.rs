use bryant_study::summary::errors::Errors;

fn errors(asked: Option<f64>, values: &[f64]) -> Errors {
    let mut errors = Errors::none(asked, values.len() as u64);
    for (row, value) in values.iter().enumerate() {
        errors.add(row as u64, *value);
    }
    errors.finish()
}

#[test]
fn says_what_is_above_and_what_is_not_known() {
    let nan = f64::NAN;
    assert_eq!(errors(None, &[]).text(), "");
    assert_eq!(
        errors(Some(1e-3), &[nan, nan]).text(),
        "estimated error: not known of any run\n"
    );
    assert_eq!(
        errors(Some(1e-3), &[1e-4, 5e-3, nan, 2e-4]).text(),
        "estimated error: median 0.020 %, largest 0.50 % (run 1); 1 run is above the 0.10 % that was asked for; \
             not known of 1 run\n"
    );
    assert_eq!(
        errors(None, &[0.0, 1e-9, 3.0]).text(),
        "estimated error: median 1.0e-7 %, largest 300 % (run 2)\n"
    );
}
