//! Engines kept in files: they come back as they were, or not at all.

use bryant_engine::{Engine, KeptError, LoadError};
use bryant_generator::Config;
use std::path::{Path, PathBuf};

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            models(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "yaml") {
            found.push(path);
        }
    }
}

#[test]
fn every_bundled_model_comes_back_with_its_functions() {
    let mut paths = Vec::new();
    models(Path::new("../models"), &mut paths);
    let mut kept = 0;
    for path in paths {
        // parts of models, and models with functions of their users
        let Ok((model, _)) = bryant_generator::read(&path) else {
            continue;
        };
        let mut options = Config::new();
        options.functions(["mass_matrix", "center_of_mass"]);
        let engine = match Engine::of(&model, &options) {
            Ok(engine) => engine,
            Err(LoadError::Engine(_)) => continue,
            Err(error) => panic!("{}: {error}", path.display()),
        };
        let again = Engine::of_kept(&engine.keep()).unwrap();
        assert!(again.lists() == engine.lists(), "{}", path.display());
        assert_eq!(again.functions().len(), 2);
        kept += 1;
    }
    assert!(kept > 10, "{kept} models");
}

#[test]
fn what_is_damaged_or_foreign_is_refused() {
    let text = "\
model: cart
dimension: 2
systems: [{ name: s, reference: fixed, elements: [{ name: cart, joint: { slider: x }, mass: 2, cg: [0, 0], inertia: 1 }] }]
run: { duration: 1, every: 0.1 }
";
    let kept = Engine::of_text("cart.yaml", text).unwrap().keep();
    assert!(Engine::of_kept(&kept).is_ok());
    let refused = |content: &[u8]| Engine::of_kept(content).unwrap_err();
    for length in 0..kept.len() {
        refused(&kept[..length]);
    }
    for place in 0..kept.len() {
        let mut changed = kept.clone();
        changed[place] ^= 1 << (place % 8);
        refused(&changed);
    }
    assert_eq!(refused(&[&kept[..], b"x"].concat()), KeptError::Other);
    // two, one behind the other, are two
    let twice = kept.repeat(2);
    assert_eq!(Engine::all_of_kept(&twice).unwrap().len(), 2);
    assert_eq!(refused(&twice), KeptError::Damaged);
    assert_eq!(refused(text.as_bytes()), KeptError::Other);
    let line = kept.iter().position(|&byte| byte == b'\n').unwrap();
    // another build of this version, which may write lists in another form
    let mut words: Vec<&str> = std::str::from_utf8(&kept[..line])
        .unwrap()
        .split(' ')
        .collect();
    words[3] = "0123456789abcdef";
    let other = [words.join(" ").as_bytes(), &kept[line..]].concat();
    let error = refused(&other).to_string();
    assert!(error.contains("another build"), "{error}");
    let other = [b"bryant engine 0.0.1", &kept[line..]].concat();
    let error = refused(&other);
    assert!(matches!(error, KeptError::Version { .. }), "{error:?}");
    assert!(error.to_string().contains("0.0.1"), "{error}");
}

#[test]
fn a_file_is_loaded_by_its_name() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("arm.bryant");
    let missing = Engine::load(&path).unwrap_err().to_string();
    assert!(missing.contains("cannot be read"), "{missing}");
    let engine = Engine::load("../models/robot-arm.yaml").unwrap();
    std::fs::write(&path, engine.keep()).unwrap();
    assert!(Engine::load(&path).unwrap().lists() == engine.lists());
    std::fs::write(&path, "model: arm").unwrap();
    assert!(matches!(
        Engine::load(&path),
        Err(LoadError::Kept(KeptError::Other))
    ));
}
