use bryant::bundled;
use bryant::command::Error;
use bryant::command::response::{Requested, intervals};
use bryant_study::facts::ModelFacts;

fn seat() -> ModelFacts {
    ModelFacts::of(&bundled::scene(bundled::find("child-seat").unwrap()).unwrap())
}

fn read(text: &str, model: &ModelFacts) -> Result<Requested, Error> {
    Requested::read("--of", text, model, [0.0, 0.12])
}

#[test]
fn windows_without_samples_are_refused() {
    let hic = [read("HIC15 of head accelerometer", &seat()).unwrap()];
    assert!(intervals(15e-3, 0.16, &hic, 8).is_ok());
    assert!(intervals(16e-3, 0.16, &hic, 8).is_err());
    assert!(intervals(0.16, 0.16, &[], 8).is_ok());
    assert!(intervals(0.17, 0.16, &[], 8).is_err());
}

#[test]
fn responses_are_understood() {
    let model = seat();
    for (text, name, unit) in [
        ("peak of lap belt force", "peak of lap belt force", "N"),
        ("peak_lap_force", "peak of lap belt force", "N"),
        (
            "hic15 of head accelerometer",
            "HIC15 of head accelerometer",
            "",
        ),
        (
            "time of peak of chin force",
            "time of peak of chin force",
            "s",
        ),
        ("time_of_peak_chin_force", "time of peak of chin force", "s"),
        (
            "value at 80 ms of head excursion",
            "value at 80 ms of head excursion",
            "m",
        ),
        (
            "clip 3 ms of chest accelerometer",
            "3 ms clip of chest accelerometer",
            "m/s^2",
        ),
        (
            "3 ms clip of chest accelerometer",
            "3 ms clip of chest accelerometer",
            "m/s^2",
        ),
        (
            "3 ms contiguous clip of chest accelerometer",
            "3 ms contiguous clip of chest accelerometer",
            "m/s^2",
        ),
    ] {
        let response = read(text, &model).unwrap_or_else(|error| panic!("{error:?}"));
        assert_eq!(
            (response.name.as_str(), response.unit.name.as_str()),
            (name, unit)
        );
    }
}

#[test]
fn outputs_are_found_whatever_their_names_are_made_of() {
    let mut model = seat();
    for (output, name) in model
        .outputs
        .iter_mut()
        .zip(["lap_force", "{}", "--", "a of b"])
    {
        output.name = name.to_owned();
    }
    for name in ["lap_force", "{}", "--", "a of b"] {
        let response = read(&format!("peak of {name}"), &model);
        let response = response.unwrap_or_else(|error| panic!("{error:?}"));
        assert_eq!(response.name, format!("peak of {name}"));
    }
}

#[test]
fn too_many_samples_are_refused_with_what_they_would_take() {
    let peak = [read("peak of lap belt force", &seat()).unwrap()];
    assert_eq!(intervals(1e-6, 0.16, &peak, 128).unwrap(), 160_000);
    match intervals(1e-8, 0.16, &peak, 128) {
        Err(Error::Input(message)) => {
            // 16 million of 128 bytes
            assert!(message.contains("makes 16000000 of") && message.contains("2.0 GB"));
            assert!(message.contains("help:"), "{message}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn responses_that_are_none_are_told() {
    let model = seat();
    for (text, needle) in [
        ("best of lap belt force", "does not begin with a response"),
        ("peak of lap belt farce", "did you mean \"lap belt force\"?"),
        (
            "peak_force",
            "several outputs have these words: lap belt force",
        ),
        ("peek of lap belt force", "did you mean \"peak\"?"),
        ("maximum of lap belt force", "did you mean \"peak\"?"),
        ("max lap belt force", "did you mean \"peak\"?"),
        ("average of lap belt force", "did you mean \"mean\"?"),
        ("HIC of head accelerometer", "did you mean \"HIC15\"?"),
        ("clip of chest accelerometer", "write `3 ms clip of OUTPUT`"),
        (
            "value of head excursion",
            "write `value at 80 ms of OUTPUT`",
        ),
        ("300 ms clip of chest accelerometer", "beyond the run"),
        ("value at 300 ms of head excursion", "beyond the run"),
        ("value at 3 kg of head excursion", "kg"),
        ("HIC15 of lap belt force", "needs an acceleration"),
        ("peak", "there are: lap belt force"),
    ] {
        match read(text, &model) {
            Err(Error::Input(message)) => {
                assert!(
                    message.contains(needle) && message.contains("help:"),
                    "{message}"
                );
            }
            other => panic!("{text}: {:?}", other.map(|r| r.name)),
        }
    }
}

#[test]
fn times_are_within_a_run_that_begins_later() {
    let read = |text| Requested::read("--response", text, &seat(), [0.06, 0.12]);
    assert!(read("value at 80 ms of head excursion").is_ok());
    for text in [
        "value at 50 ms of head excursion",
        "70 ms clip of chest accelerometer",
    ] {
        match read(text).map(|response| response.name) {
            Err(Error::Input(message)) => assert!(message.contains("from 0.06 s to 0.12 s")),
            other => panic!("{other:?}"),
        }
    }
}
