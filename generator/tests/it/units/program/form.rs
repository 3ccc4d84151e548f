use bryant_generator::program::form::FILES;
use std::path::{Path, PathBuf};

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => sources(&path, found),
            false => found.push(path),
        }
    }
}

/// A file with a type that is read by serde is either in the list or one of those that read YAML.
#[test]
fn no_file_is_forgotten() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    sources(&source, &mut paths);
    let of_yaml = ["human/", "car_part.rs", "program/form.rs"];
    for path in paths {
        let text = std::fs::read_to_string(&path).expect("a source");
        let name = path.strip_prefix(&source).expect("below it");
        let name = name.to_str().expect("UTF-8").replace('\\', "/");
        let reads = text.contains("Deserialize") && !of_yaml.iter().any(|of| name.starts_with(of));
        assert!(
            !reads || FILES.contains(&&text[..]),
            "{name} is missing in FILES"
        );
    }
}
