//! Pictures of a run and of a study: their views, and their formats.

use super::called::call;
use super::directory;
use std::path::Path;

const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

fn is_png(path: &Path) -> bool {
    std::fs::read(path).is_ok_and(|bytes| bytes.starts_with(PNG))
}

#[test]
fn every_picture_can_be_had_as_png() {
    let directory = directory();
    let here = directory.path();
    let run = ["run", "clock.yaml", "--plot", "swing", "--pictures"];
    call(here, &[&run[..], &["png"]].concat(), 0);
    assert!(is_png(&here.join("clock.png")));
    assert!(is_png(&here.join("clock-swing-over-time.png")));
    assert!(!here.join("clock.svg").exists());
    call(here, &[&run[..], &["svg"]].concat(), 0);
    let plot = std::fs::read_to_string(here.join("clock-swing-over-time.svg")).unwrap();
    assert!(plot.starts_with("<svg") && plot.contains("swing [rad]"));

    let study = "\
model: clock.yaml
design: saltelli
runs: 48
parameters: { gravity: { from: 5, to: 15 } }
responses: [{ of: bob height, what: mean }]
";
    std::fs::write(here.join("study.yaml"), study).unwrap();
    call(here, &["sweep", "study.yaml", "--pictures", "png"], 0);
    for name in ["scatter", "tornado"] {
        assert!(is_png(&here.join(format!("study-results/{name}.png"))));
    }
    call(here, &["merge", "study-results"], 0);
    let scatter = std::fs::read_to_string(here.join("study-results/scatter.svg")).unwrap();
    assert!(scatter.contains("mean of bob height [m]") && scatter.contains("gravity [m/s²]"));
}

#[test]
fn a_model_in_space_is_seen_from_where_asked() {
    let directory = directory();
    for (view, across, upwards) in [
        ("side", "x [m]", "z [m]"),
        ("front", "y [m]", "z [m]"),
        ("top", "x [m]", "y [m]"),
        ("oblique", "across [m]", "up [m]"),
    ] {
        let picture = ["--no-files", "--picture", "-", "--view", view];
        let run = ["run", "dummy15", "--duration", "20 ms", "--no-verify"];
        let (svg, _) = call(directory.path(), &[&run[..], &picture].concat(), 0);
        for name in [across, upwards] {
            assert!(svg.contains(&format!(">{name}<")), "{view}: no {name}");
        }
    }
    let planar = ["run", "clock.yaml", "--view", "top"];
    let (_, told) = call(directory.path(), &planar, 2);
    assert!(told.contains("clock is planar") && told.contains("help: leave out --view"));
    let (_, told) = call(
        directory.path(),
        &["run", "clock.yaml", "--view", "back"],
        2,
    );
    assert!(told.contains("oblique"), "{told}");
    assert!(!directory.path().join("clock.csv").exists());
}
