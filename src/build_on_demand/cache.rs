//! A cache directory: an entry in it is complete, or does not exist.
//!
//! The files in it are loaded and run. So the directory must belong to this user or to root, and nobody else may write
//! into it. The file of an entry must have the length and the SHA-256 that a file beside it says.

use super::{BuildError, HOME};
use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Prefix of the names of directories that are still being filled.
pub const BUILDING: &str = ".building-";
/// A directory that is older is not being filled any more.
pub const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// The directory of compiled libraries.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cache {
    /// The directory; it need not exist.
    pub root: PathBuf,
}

impl Cache {
    /// `$BRYANT_CACHE`, else `$XDG_CACHE_HOME/bryant`, else the system's directory for caches.
    pub fn find() -> Result<Self, BuildError> {
        Self::of(|name| {
            std::env::var_os(name)
                .filter(|v| !v.is_empty())
                .map(PathBuf::from)
        })
    }

    // Public for the tests in `tests/suite/units`, which are compiled apart from this crate.
    #[doc(hidden)]
    pub fn of(variable: impl Fn(&str) -> Option<PathBuf>) -> Result<Self, BuildError> {
        let under = |base: PathBuf| base.join("bryant");
        let home = variable(HOME).map(|home| match std::env::consts::OS {
            "windows" => home,
            "macos" => home.join("Library/Caches"),
            _ => home.join(".cache"),
        });
        let root = variable("BRYANT_CACHE")
            // a relative path is ignored, as the XDG specification says
            .or_else(|| {
                variable("XDG_CACHE_HOME")
                    .filter(|p| p.is_absolute())
                    .map(under)
            })
            .or_else(|| home.map(under));
        root.map(|root| Self { root }).ok_or(BuildError::NoCache)
    }

    /// The path of `file` in the entry `name`. If the entry does not exist, `build` fills a directory that becomes the
    /// entry.
    pub fn entry(
        &self,
        name: &str,
        file: &str,
        build: impl FnOnce(&Path) -> Result<(), BuildError>,
    ) -> Result<PathBuf, BuildError> {
        let entry = self.root.join(name);
        let wanted = entry.join(file);
        if self.root.exists() {
            trusted(&self.root)?;
            if self.has(&entry, &wanted)? {
                return Ok(wanted);
            }
        }
        create_private(&self.root).map_err(|e| self.fault(e))?;
        self.remove_abandoned();
        let mut prefix = std::ffi::OsString::from(BUILDING);
        prefix.push(name);
        let temporary = tempfile::Builder::new()
            .prefix(&prefix)
            .tempdir_in(&self.root)
            .map_err(|e| self.fault(e))?;
        build(temporary.path())?;
        seal(temporary.path(), file).map_err(|e| self.fault(e))?;
        let built = temporary.keep();
        let Err(error) = std::fs::rename(&built, &entry) else {
            sync_directory(&self.root);
            return Ok(wanted);
        };
        // Another process was faster; or an entry with a missing or damaged file is in the way, and is replaced.
        let moved = if self.has(&entry, &wanted)? {
            Ok(())
        } else {
            remove(&entry).and_then(|()| std::fs::rename(&built, &entry))
        };
        if built.exists() {
            // A directory that remains does no harm, because nothing looks for its name.
            let _ = remove(&built);
        }
        match moved {
            Ok(()) => Ok(wanted),
            Err(_) if self.has(&entry, &wanted)? => Ok(wanted),
            Err(_) => Err(self.fault(error)),
        }
    }

    /// True if an entry has its file, undamaged.
    ///
    /// # Errors
    /// Other users may have written the entry.
    fn has(&self, entry: &Path, wanted: &Path) -> Result<bool, BuildError> {
        if !wanted.is_file() {
            return Ok(false);
        }
        trusted(entry)?;
        trusted(wanted)?;
        let said = std::fs::read_to_string(seal_of(wanted));
        Ok(said.is_ok_and(|said| checksum(wanted).is_ok_and(|is| is == said)))
    }

    /// Removes directories that were begun more than a day ago: the processes that filled them have ended.
    fn remove_abandoned(&self) {
        let Ok(entries) = std::fs::read_dir(&self.root) else {
            return;
        };
        for entry in entries.flatten() {
            let name = entry.file_name();
            let age = entry.metadata().and_then(|about| about.modified());
            let age = age.map(|modified| modified.elapsed().unwrap_or_default());
            if name.to_string_lossy().starts_with(BUILDING) && age.is_ok_and(|age| age > ABANDONED)
            {
                // a directory that remains does no harm
                let _ = remove(&entry.path());
            }
        }
    }

    /// Keeps the sources and messages of a failed compilation in the directory `failed`, for a report.
    pub fn keep_failure(&self, directory: &Path, messages: &str) -> PathBuf {
        let kept = self.root.join("failed");
        let copied = std::fs::create_dir_all(&kept).and_then(|()| {
            for name in ["main.rs", "model.rs"] {
                if directory.join(name).is_file() {
                    std::fs::copy(directory.join(name), kept.join(name))?;
                }
            }
            std::fs::write(kept.join("messages.txt"), messages)
        });
        // if copying fails, the error still contains the first message of the compiler
        let _ = copied;
        kept
    }

    fn fault(&self, source: io::Error) -> BuildError {
        BuildError::Cache {
            path: self.root.clone(),
            source,
        }
    }
}

/// The path of the file with the length and the SHA-256 of another file.
pub fn seal_of(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".sha256");
    name.into()
}

/// Writes the checksum of a file beside it, and flushes both to disk. After a loss of power, either both are complete,
/// or the checksum does not fit.
fn seal(directory: &Path, file: &str) -> io::Result<()> {
    let file = directory.join(file);
    // some users' settings let their group write new files
    #[cfg(unix)]
    for path in [directory, &file] {
        use std::os::unix::fs::PermissionsExt;
        let mode = std::fs::metadata(path)?.permissions().mode();
        std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode & !0o022))?;
    }
    sync(&file)?;
    let seal = seal_of(&file);
    std::fs::write(&seal, checksum(&file)?)?;
    sync(&seal)?;
    sync_directory(directory);
    Ok(())
}

/// Flushes a file to disk.
fn sync(file: &Path) -> io::Result<()> {
    // Windows flushes only files that are open for writing
    let file = std::fs::OpenOptions::new().write(true).open(file)?;
    file.sync_all()
}

/// Flushes the names in a directory to disk, if the system can.
fn sync_directory(directory: &Path) {
    if let Ok(directory) = File::open(directory) {
        // if directories cannot be flushed, the checksum detects missing data
        let _ = directory.sync_all();
    }
}

/// Length in bytes and SHA-256.
fn checksum(file: &Path) -> io::Result<String> {
    let mut file = File::open(file)?;
    let mut hasher = Sha256::new();
    let mut length = 0;
    let mut piece = vec![0; 1 << 16];
    loop {
        let read = file.read(&mut piece)?;
        if read == 0 {
            break;
        }
        hasher.update(&piece[..read]);
        length += read;
    }
    let hexadecimal: Vec<String> = hasher
        .finalize()
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect();
    Ok(format!("{length} {}\n", hexadecimal.concat()))
}

/// Creates a directory that nobody else may read or write. Directories above it are created as usual.
fn create_private(path: &Path) -> io::Result<()> {
    if let Some(above) = path.parent() {
        std::fs::create_dir_all(above)?;
    }
    #[cfg(not(unix))]
    let created = std::fs::create_dir(path);
    #[cfg(unix)]
    let created = {
        let mut builder = std::fs::DirBuilder::new();
        std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
        builder.create(path)
    };
    match created {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        done => done,
    }
}

/// Refuses a file or directory that belongs to someone other than this user and root, or that others may write. Links
/// are followed.
#[cfg(unix)]
#[expect(
    unsafe_code,
    reason = "the user of this process is known to the C library alone"
)]
fn trusted(path: &Path) -> Result<(), BuildError> {
    use std::os::unix::fs::MetadataExt;
    let about = std::fs::metadata(path).map_err(|source| BuildError::Cache {
        path: path.to_owned(),
        source,
    })?;
    // SAFETY: the function has no arguments and cannot fail.
    let user = unsafe { libc::geteuid() };
    match is_safe(about.uid(), about.mode(), user) {
        Ok(()) => Ok(()),
        Err(reason) => Err(BuildError::Untrusted {
            path: path.to_owned(),
            reason,
        }),
    }
}

/// Accepts every path: on other systems, caches are in directories of the user.
#[cfg(not(unix))]
fn trusted(_: &Path) -> Result<(), BuildError> {
    Ok(())
}

/// Checks that only `user` and root can change a file; else returns the reason.
#[cfg(unix)]
pub fn is_safe(owner: u32, mode: u32, user: u32) -> Result<(), &'static str> {
    if owner != user && owner != 0 {
        return Err("it belongs to another user");
    }
    match mode & 0o022 {
        0 => Ok(()),
        bits if bits & 0o002 != 0 => Err("everybody may write into it"),
        _ => Err("its group may write into it"),
    }
}

fn remove(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        std::fs::remove_dir_all(path)
    } else {
        std::fs::remove_file(path)
    }
}
