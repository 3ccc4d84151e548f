//! Files that are whole or not there: written beside their place, made to last, then moved into it.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

impl WriteError {
    /// What to do first, in the beginning of a sentence.
    pub fn remedy(&self) -> &'static str {
        match self.source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                "the disk is full: make room, then"
            }
            _ => "when its cause is gone,",
        }
    }
}

/// Beginning of the names of files that are being written.
pub const UNFINISHED: &str = ".unfinished-";

/// Replaces a file by what `content` writes; a failure, or the end of the process, leaves the old one or none.
///
/// # Errors
/// The directory is not there or cannot be written to, the disk is full.
pub fn replace<E: From<WriteError>>(
    path: &Path,
    content: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), E>,
) -> Result<(), E> {
    let failed = |source| WriteError {
        path: path.to_owned(),
        source,
    };
    let directory = path.parent().unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED);
    // Readable as any file that a program creates, not only by its owner.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o644));
    }
    let mut temporary = builder.tempfile_in(directory).map_err(failed)?;
    {
        let mut file = BufWriter::new(temporary.as_file_mut());
        content(&mut file)?;
        file.flush().map_err(failed)?;
    }
    temporary.as_file().sync_all().map_err(failed)?;
    temporary
        .persist(path)
        .map_err(|error| failed(error.error))?;
    // The new name, too, must outlast a loss of power; where directories cannot be opened, the system sees to it.
    if cfg!(unix) {
        File::open(directory)
            .and_then(|d| d.sync_all())
            .map_err(failed)?;
    }
    Ok(())
}

/// Turns an error of writing `path` into one that names it.
pub fn at<T>(path: &Path, result: io::Result<T>) -> Result<T, WriteError> {
    result.map_err(|source| WriteError {
        path: path.to_owned(),
        source,
    })
}
