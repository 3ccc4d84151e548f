//! The interface that a build script uses, in directories of its own.

use bryant_generator::model::Coordinates;
use bryant_generator::{Config, Error};
use std::fs;
use std::path::{Path, PathBuf};

const PENDULUM: &str = "
model: NAME
dimension: 3
include: [rod.yaml]
systems:
  - { name: arm, reference: fixed }
";

const ROD: &str = "
systems:
  - name: arm
    elements:
      - { name: rod, mass: 1 kg, cg: [0, 0, -0.5], inertia: [0.1, 0.1, 0.01] }
";

/// A directory with models of these names and the files that they include.
fn models(test: &str, names: &[&str]) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(directory.join("models")).expect("a directory");
    for name in names {
        let text = PENDULUM.replace("NAME", name);
        fs::write(directory.join(format!("models/{name}.yaml")), text).expect("a model");
    }
    // This file is not a model and must not be taken for one.
    fs::write(directory.join("models/rod.yaml"), ROD).expect("a part");
    directory
}

fn config(directory: &Path, names: &[&str]) -> Config {
    let mut config = Config::new();
    config.out_dir(directory.join("out"));
    for name in names {
        config.model(directory.join(format!("models/{name}.yaml")));
    }
    config
}

#[test]
fn each_model_gets_its_file_and_says_what_it_read() -> Result<(), Error> {
    let directory = models("each", &["left", "right"]);
    let all = config(&directory, &["left", "right"]).generate()?;
    for (generated, name) in all.iter().zip(["left", "right"]) {
        assert_eq!(generated.name, name);
        assert_eq!(generated.written, directory.join(format!("out/{name}.rs")));
        let text = fs::read_to_string(&generated.written).expect("a file");
        assert!(text == generated.source && text.contains(&format!("from {name}.yaml")));
        let read = [format!("models/{name}.yaml"), "models/rod.yaml".into()];
        assert_eq!(generated.read, read.map(|path| directory.join(path)));
    }
    let files = fs::read_dir(directory.join("out"))
        .expect("a directory")
        .count();
    assert_eq!(files, 2, "nothing temporary is left");
    Ok(())
}

#[test]
fn a_file_that_would_not_change_is_not_written() -> Result<(), Error> {
    let directory = models("unchanged", &["arm"]);
    let config = config(&directory, &["arm"]);
    let path = config.generate()?[0].written.clone();
    let before = fs::metadata(&path)
        .and_then(|data| data.modified())
        .expect("a time");
    config.generate()?;
    let after = fs::metadata(&path)
        .and_then(|data| data.modified())
        .expect("a time");
    assert_eq!(before, after);
    Ok(())
}

#[test]
fn all_problems_of_all_models_are_told_and_nothing_is_written() {
    let directory = models("problems", &["good", "heavy", "light"]);
    for (name, wrong) in [("heavy", "mas: 1"), ("light", "lenght: 2")] {
        let path = directory.join(format!("models/{name}.yaml"));
        let text = fs::read_to_string(&path).expect("a model") + wrong + "\n";
        fs::write(path, text).expect("a model");
    }
    let Err(Error::Description(problems)) =
        config(&directory, &["good", "heavy", "light"]).generate()
    else {
        panic!("the models are wrong");
    };
    let lines: Vec<String> = problems.lines().collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    for (line, (name, key)) in lines.iter().zip([("heavy", "mas"), ("light", "lenght")]) {
        assert!(
            line.contains(&format!("models/{name}.yaml:7:1: ")),
            "{line}"
        );
        assert!(line.contains(key) && line.contains("help: "), "{line}");
    }
    assert!(!directory.join("out/good.rs").exists());
}

#[test]
fn two_models_do_not_overwrite_each_other() {
    let directory = models("same", &["arm"]);
    fs::create_dir(directory.join("more")).expect("a directory");
    for file in ["arm.yaml", "rod.yaml"] {
        fs::copy(
            directory.join("models").join(file),
            directory.join("more").join(file),
        )
        .expect("a copy");
    }
    let mut config = config(&directory, &["arm"]);
    let message = match config.model(directory.join("more/arm.yaml")).generate() {
        Err(error) => error.to_string(),
        Ok(_) => panic!("two models of one name"),
    };
    assert!(
        message.contains("more/arm.yaml") && message.contains("rename one"),
        "{message}"
    );
}

#[test]
fn a_directory_is_read_by_name() -> Result<(), Error> {
    let directory = models("directory", &["b", "a", "c"]);
    fs::remove_file(directory.join("models/rod.yaml")).expect("a part");
    fs::create_dir(directory.join("models/parts")).expect("a directory");
    fs::write(directory.join("models/parts/rod.yaml"), ROD).expect("a part");
    for name in ["a", "b", "c"] {
        let text = PENDULUM
            .replace("NAME", name)
            .replace("rod.yaml", "parts/rod.yaml");
        fs::write(directory.join(format!("models/{name}.yaml")), text).expect("a model");
    }
    let all = Config::new()
        .out_dir(directory.join("out"))
        .models_in(directory.join("models"))
        .generate()?;
    let names: Vec<&str> = all
        .iter()
        .map(|generated| generated.name.as_str())
        .collect();
    assert_eq!(names, ["a", "b", "c"]);
    Ok(())
}

#[test]
fn a_robot_of_a_urdf_file_is_a_model() -> Result<(), Error> {
    let directory = models("robot", &[]);
    let path = directory.join("models/two-arm.urdf");
    let robot = "<robot name=\"Two Arm\"><link name=\"base\"/><link name=\"arm\"><inertial><mass value=\"1\"/>\
        <inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\
        <joint name=\"turn\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/></joint></robot>";
    fs::write(&path, robot).expect("a robot");
    let mut config = Config::new();
    let all = config
        .out_dir(directory.join("out"))
        .model(&path)
        .generate()?;
    assert_eq!(all[0].model.name, "two-arm");
    assert_eq!(all[0].model.systems[0].elements.len(), 1);
    assert_eq!(all[0].read, std::slice::from_ref(&path));

    fs::write(
        &path,
        robot.replace("child link=\"arm\"", "child link=\"leg\""),
    )
    .expect("a robot");
    let Err(Error::Description(problems)) = config.generate() else {
        panic!("it is accepted");
    };
    let said = problems.to_string();
    assert!(
        said.contains("two-arm.urdf:1:") && said.contains("\"leg\""),
        "{said}"
    );
    Ok(())
}

#[test]
fn models_are_written_as_c_where_that_is_asked_for() -> Result<(), Error> {
    let directory = models("as-c", &["arm", "an-arm"]);
    let c = directory.join("c");
    config(&directory, &["arm", "an-arm"])
        .emit_c(&c)
        .generate()?;
    for name in ["arm", "an_arm"] {
        let header = fs::read_to_string(c.join(format!("{name}.h"))).expect("a header");
        assert!(
            header.contains(&format!("void {name}_derivative(")),
            "{header}"
        );
        let source = fs::read_to_string(c.join(format!("{name}.c"))).expect("a source");
        assert!(
            source.contains(&format!("#include \"{name}.h\"")),
            "{source}"
        );
    }
    assert_eq!(fs::read_dir(&c).expect("files").count(), 4);

    // two files with models of the same name
    let directory = models("one-in-c", &["arm", "leg"]);
    let text = PENDULUM.replace("NAME", "arm");
    fs::write(directory.join("models/leg.yaml"), text).expect("a model");
    let mut config = config(&directory, &["arm", "leg"]);
    let Err(Error::Description(problems)) = config.emit_c(directory.join("c")).generate() else {
        panic!("one overwrites the other");
    };
    assert!(problems.to_string().contains("arm.c"), "{problems}");
    assert!(!directory.join("c").exists());
    Ok(())
}

#[test]
fn a_missing_directory_is_named() {
    let directory = models("missing", &[]);
    let result = Config::new()
        .out_dir(&directory)
        .models_in(directory.join("nowhere"))
        .generate();
    let message = result.map(|_| ()).expect_err("no directory").to_string();
    assert!(message.contains("nowhere"), "{message}");
}

#[test]
fn coordinates_and_matrices_are_the_callers_choice() -> Result<(), Error> {
    let directory = models("choice", &["arm"]);
    let source = |config: &Config| config.generate().map(|mut all| all.remove(0).source);
    let mut config = config(&directory, &["arm"]);
    let quaternion = source(&config)?;
    assert!(quaternion.contains("arm/rod.qw") && quaternion.contains("mass_matrix"));
    let bryant = source(config.coordinates(Coordinates::Bryant).matrices(false))?;
    assert!(bryant.contains("arm/rod.phi1") && !bryant.contains("mass_matrix"));
    Ok(())
}

#[test]
fn text_goes_in_and_text_comes_out() {
    let text = PENDULUM.replace("NAME", "arm");
    let loader = |path: &Path| match path.to_str() {
        Some("models/rod.yaml") => Ok(ROD.to_string()),
        _ => Err(std::io::ErrorKind::NotFound.into()),
    };
    let generated = Config::new()
        .generate_str("models/arm.yaml", &text, &loader)
        .expect("a model");
    assert_eq!(generated.name, "arm");
    assert!(generated.source.contains("pub struct Mechanism<T>"));
    assert_eq!(generated.written, PathBuf::new());
}

/// A function in a file is included by its path; one whose file has inner documentation stays as it is.
#[test]
fn files_of_the_users_are_included_where_they_are() {
    let bundled = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models");
    let at = std::env::temp_dir().join(format!("bryant-include-{}", std::process::id()));
    std::fs::create_dir_all(at.join("forces")).expect("a directory");
    let model = std::fs::read_to_string(bundled.join("skydiver.yaml")).expect("a model");
    let drag = std::fs::read_to_string(bundled.join("forces/drag.rs")).expect("a function");
    std::fs::write(at.join("skydiver.yaml"), model).expect("a file");
    let mut texts = Vec::new();
    let outer = drag.replace("//!", "//");
    assert_ne!(outer, drag);
    for text in [&drag, &outer] {
        std::fs::write(at.join("forces/drag.rs"), text).expect("a file");
        let mut config = Config::new();
        let all = config
            .model(at.join("skydiver.yaml"))
            .out_dir(at.join("out"))
            .generate();
        let all = all.expect("a module");
        texts.push((
            all[0].source.clone(),
            bryant_generator::config::including(&all[0]),
        ));
    }
    std::fs::remove_dir_all(&at).expect("removed");
    let [(source, inner), (pasted, included)] = &texts[..] else {
        unreachable!()
    };
    assert_eq!(source, inner);
    assert!(pasted.contains("let factor = ") && !included.contains("let factor = "));
    let path = at.join("forces/drag.rs").display().to_string();
    assert!(
        included.contains(&format!("::core::include!({path:?});")),
        "{included}"
    );
    syn::parse_file(included).expect("Rust");
}
