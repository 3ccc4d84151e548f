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
