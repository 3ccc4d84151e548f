//! Writes files that are always complete: a file is written under another name and then renamed.

use std::io::{self, BufWriter, Write};
use std::path::{Component, Path, PathBuf};

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub source: io::Error,
}

/// Replaces a file by the output of `content`. Missing directories are created; after a failure, the old file remains.
pub fn replace(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    write(path, content).map_err(|source| WriteError {
        path: path.to_owned(),
        source,
    })
}

fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let path = &behind_links(path)?;
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if path.is_dir() {
        return Err(io::Error::other("it is a directory"));
    }
    std::fs::create_dir_all(directory)?;
    // A file that is not regular (a pipe, /dev/null, NUL) cannot be replaced, but only written to.
    let device = cfg!(windows) && path.as_os_str().eq_ignore_ascii_case("NUL");
    if device || path.exists() && !path.is_file() {
        let mut file = BufWriter::new(std::fs::OpenOptions::new().write(true).open(path)?);
        content(&mut file)?;
        return file.flush();
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".bryant-");
    // The file is readable like any file that a program creates, not only by its owner.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let mode = match std::fs::metadata(path) {
            Ok(old) => old.permissions().mode(),
            Err(_) => 0o644,
        };
        builder.permissions(std::fs::Permissions::from_mode(mode));
    }
    let mut temporary = builder.tempfile_in(directory)?;
    {
        let mut file = BufWriter::new(temporary.as_file_mut());
        content(&mut file)?;
        file.flush()?;
    }
    temporary.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// The reason why Windows does not allow this name for a file; `None` if it does. Some of these names are devices
/// there, or parts of a file, so that what is written is lost.
///
/// Microsoft, *Naming Files, Paths, and Namespaces*.
pub fn refusal_of_windows(name: &str) -> Option<&'static str> {
    if name
        .contains(|c: char| c.is_control() || matches!(c, '<' | '>' | ':' | '"' | '|' | '?' | '*'))
    {
        return Some("has a character that Windows allows in no name");
    }
    if name.ends_with(['.', ' ']) {
        return Some("ends in a dot or a space, which Windows leaves out");
    }
    let stem = name.split('.').next().unwrap_or_default().trim_end();
    let device = match stem.to_ascii_lowercase().as_str() {
        "con" | "prn" | "aux" | "nul" => true,
        stem => ["com", "lpt"].iter().any(|kind| {
            let number = stem.strip_prefix(kind);
            number.is_some_and(|n| {
                matches!(n, "¹" | "²" | "³") || matches!(n.as_bytes(), [b'0'..=b'9'])
            })
        }),
    };
    device.then_some("is the name of a device on Windows")
}

/// Largest number of links that are followed to a file, the same as in Linux.
const MOST_LINKS: usize = 40;

/// The file that a path leads to when links are followed. So a link remains, and its target is replaced. The file need
/// not exist.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match std::fs::read_link(&path) {
            Ok(target) => path = path.parent().unwrap_or(Path::new("")).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many links"))
}

/// The real place of a path, with links followed. Two paths to one file have the same place, whatever their form and
/// whether the file exists or not.
pub fn place(path: &Path) -> PathBuf {
    let path = behind_links(path).unwrap_or(path.to_owned());
    if let Ok(place) = path.canonicalize() {
        return place;
    }
    let directory = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    match path.components().next_back() {
        Some(Component::Normal(name)) => place(directory).join(name),
        // the path does not exist yet
        Some(Component::ParentDir) => place(directory).parent().map_or(path, Path::to_owned),
        _ => path,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_the_old_file_and_no_other() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("deep/er/table.csv");
        replace(&path, |out| out.write_all(b"old")).unwrap();
        let failure = replace(&path, |out| {
            out.write_all(b"new")?;
            Err(io::Error::other("disk full"))
        });
        let message = failure.unwrap_err().to_string();
        assert!(message.contains("table.csv") && message.contains("disk full"));
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        let files = std::fs::read_dir(path.parent().unwrap()).unwrap().count();
        assert_eq!(files, 1);
    }

    #[test]
    fn names_of_devices_are_no_names_of_files_on_windows() {
        let bad = "con con.csv CON.tar.gz aux nul.svg prn.h com1.csv LPT9 lpt0.x com¹.csv a:b.csv what?.csv a. b<c \u{7}";
        for name in bad.split(' ').chain(["a ", "con .csv"]) {
            assert!(refusal_of_windows(name).is_some(), "{name}");
        }
        for name in
            "child-seat.csv console.csv com.csv com10.svg lpt .hidden a.con nul-1.csv".split(' ')
        {
            assert_eq!(refusal_of_windows(name), None, "{name}");
        }
    }

    #[test]
    fn a_directory_is_not_replaced() {
        let directory = tempfile::tempdir().unwrap();
        assert!(replace(directory.path(), |_| Ok(())).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_what_it_points_to_is_replaced() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| directory.path().join(name);
        std::fs::create_dir(at("real")).unwrap();
        std::os::unix::fs::symlink("real/table.csv", at("there")).unwrap();
        std::os::unix::fs::symlink("there", at("link")).unwrap();
        for text in ["first", "second"] {
            replace(&at("link"), |out| out.write_all(text.as_bytes())).unwrap();
            assert_eq!(std::fs::read_to_string(at("real/table.csv")).unwrap(), text);
            assert!(std::fs::symlink_metadata(at("link")).unwrap().is_symlink());
        }
        std::os::unix::fs::symlink("round", at("round")).unwrap();
        let round = replace(&at("round"), |_| Ok(()));
        assert!(round.unwrap_err().to_string().contains("too many links"));
    }

    #[test]
    fn a_place_is_one_however_it_is_named() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| place(&directory.path().join(name));
        std::fs::write(directory.path().join("there"), "").unwrap();
        for [one, other] in [
            ["there", "./there"],
            ["there", "new/../there"],
            ["a.csv", "./a.csv"],
            ["a.csv", "new/../a.csv"],
            ["new/a.csv", "new/./a.csv"],
            ["new/er/../a.csv", "new/a.csv"],
        ] {
            assert_eq!(at(one), at(other), "{one} {other}");
        }
        assert_ne!(at("a.csv"), at("new/a.csv"));
        #[cfg(unix)]
        for [link, target] in [["link", "there"], ["loose", "a.csv"]] {
            std::os::unix::fs::symlink(target, directory.path().join(link)).unwrap();
            assert_eq!(at(link), at(target), "{link}");
        }
    }
}
