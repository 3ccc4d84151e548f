//! A number that tells whether two builds of the generator write [`Lists`](super::Lists) in the same form.

/// The files whose types are part of `Lists`, or of what these are made of: all from which `Lists` are read again.
const FILES: &[&str] = &[
    include_str!("lists.rs"),
    include_str!("list.rs"),
    include_str!("facts.rs"),
    include_str!("../equations.rs"),
    include_str!("../expression/node.rs"),
    include_str!("../method/mod.rs"),
    include_str!("../model/curve.rs"),
    include_str!("../model/rule.rs"),
    include_str!("../model/units.rs"),
];

/// A digest of the text of these files: lists that were written by a build with the same number can be read. Another
/// number may mean nothing but another comment.
pub const FORM: u64 = digest(FILES);

/// FNV-1a of 64 bits, without carriage returns, which some systems add.
const fn digest(texts: &[&str]) -> u64 {
    let (mut digest, mut text) = (0xcbf2_9ce4_8422_2325_u64, 0);
    while text < texts.len() {
        let (bytes, mut i) = (texts[text].as_bytes(), 0);
        while i < bytes.len() {
            if bytes[i] != b'\r' {
                digest = (digest ^ bytes[i] as u64).wrapping_mul(0x0100_0000_01b3);
            }
            i += 1;
        }
        text += 1;
    }
    digest
}

#[cfg(test)]
mod tests {
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
            let reads =
                text.contains("Deserialize") && !of_yaml.iter().any(|of| name.starts_with(of));
            assert!(
                !reads || super::FILES.contains(&&text[..]),
                "{name} is missing in FILES"
            );
        }
    }
}
