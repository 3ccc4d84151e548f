//! Writes files that are always complete: a file is written under another name, flushed to disk, then renamed.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct WriteError {
    /// The file.
    pub path: PathBuf,
    /// The reason.
    pub source: io::Error,
}

impl WriteError {
    /// The remedy for the failure, as the beginning of a sentence that the caller completes.
    pub fn remedy(&self) -> &'static str {
        match self.source.kind() {
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
                "the disk is full: make room, then"
            }
            _ => "when its cause is gone,",
        }
    }
}

/// Prefix of the names of unfinished files.
pub const UNFINISHED: &str = ".unfinished-";

/// Replaces a file by the output of `content`. If this fails or the process ends, the old file remains, or none if
/// there was none.
///
/// # Errors
/// The directory does not exist or cannot be written to, or the disk is full.
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
    // The file is readable like any file that a program creates, not only by its owner.
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
    // The new name must survive a loss of power, too. Where directories cannot be opened, the system ensures this.
    if cfg!(unix) {
        File::open(directory)
            .and_then(|d| d.sync_all())
            .map_err(failed)?;
    }
    Ok(())
}

/// Adds the path to an error of writing.
pub fn at<T>(path: &Path, result: io::Result<T>) -> Result<T, WriteError> {
    result.map_err(|source| WriteError {
        path: path.to_owned(),
        source,
    })
}
