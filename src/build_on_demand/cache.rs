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
const BUILDING: &str = ".building-";
/// A directory that is older is not being filled any more.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

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

    fn of(variable: impl Fn(&str) -> Option<PathBuf>) -> Result<Self, BuildError> {
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
fn seal_of(file: &Path) -> PathBuf {
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
fn is_safe(owner: u32, mode: u32, user: u32) -> Result<(), &'static str> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn cache() -> (tempfile::TempDir, Cache) {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path().join("cache");
        (directory, Cache { root })
    }

    fn fill(directory: &Path) -> Result<(), BuildError> {
        super::super::write(&directory.join("model"), "program")
    }

    #[test]
    fn an_entry_is_built_once() {
        let (_directory, cache) = cache();
        let first = cache.entry("a", "model", fill).unwrap();
        let second = cache
            .entry("a", "model", |_| unreachable!("it is there"))
            .unwrap();
        assert_eq!(first, second);
        assert_eq!(std::fs::read_to_string(first).unwrap(), "program");
    }

    #[test]
    fn a_failed_build_leaves_nothing() {
        let (_directory, cache) = cache();
        let failure = cache.entry("a", "model", |directory| {
            fill(directory)?;
            Err(BuildError::NoCache)
        });
        assert!(failure.is_err());
        assert_eq!(std::fs::read_dir(&cache.root).unwrap().count(), 0);
    }

    #[test]
    fn the_faster_of_two_builders_wins_and_a_ruin_is_replaced() {
        let (_directory, cache) = cache();
        let slow = cache.entry("a", "model", |directory| {
            cache.entry("a", "model", fill)?;
            super::super::write(&directory.join("model"), "other")
        });
        assert_eq!(std::fs::read_to_string(slow.unwrap()).unwrap(), "program");
        std::fs::remove_file(cache.root.join("a/model")).unwrap();
        std::fs::write(cache.root.join("a/rest"), "").unwrap();
        let again = cache.entry("a", "model", fill).unwrap();
        assert_eq!(std::fs::read_to_string(again).unwrap(), "program");
        assert_eq!(std::fs::read_dir(&cache.root).unwrap().count(), 1);
    }

    #[test]
    fn a_damaged_entry_is_built_again() {
        let (_directory, cache) = cache();
        let path = cache.entry("a", "model", fill).unwrap();
        for damage in ["", "prog", "Program", "program and more"] {
            std::fs::write(&path, damage).unwrap();
            let again = cache.entry("a", "model", fill).unwrap();
            assert_eq!(
                std::fs::read_to_string(again).unwrap(),
                "program",
                "{damage}"
            );
        }
        std::fs::remove_file(seal_of(&path)).unwrap();
        let mut built = false;
        cache
            .entry("a", "model", |directory| {
                built = true;
                fill(directory)
            })
            .unwrap();
        assert!(built, "an entry without its checksum may be anything");
    }

    #[cfg(unix)]
    #[test]
    fn what_others_may_write_is_not_used() {
        use std::os::unix::fs::PermissionsExt;
        let (directory, cache) = cache();
        let path = cache.entry("a", "model", fill).unwrap();
        let set = |path: &Path, mode| {
            std::fs::set_permissions(path, std::fs::Permissions::from_mode(mode)).unwrap();
        };
        let mode = std::fs::metadata(&cache.root).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o700);
        // the cache may be named by a link
        let link = directory.path().join("link");
        std::os::unix::fs::symlink(&cache.root, &link).unwrap();
        let linked = Cache { root: link };
        let entry = cache.root.join("a");
        for (place, good) in [(&cache.root, 0o700), (&entry, 0o755), (&path, 0o644)] {
            for bits in [0o020, 0o002] {
                set(place, good | bits);
                for cache in [&cache, &linked] {
                    let refused = cache.entry("a", "model", fill).unwrap_err().to_string();
                    assert!(refused.contains("chmod"), "{refused}");
                }
            }
            set(place, good);
            assert!(linked.entry("a", "model", fill).is_ok());
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_cache_belongs_to_its_user_or_to_root() {
        assert!(is_safe(1000, 0o40700, 1000).is_ok() && is_safe(0, 0o40755, 1000).is_ok());
        assert!(is_safe(1001, 0o40700, 1000).is_err() && is_safe(65534, 0o40700, 0).is_err());
    }

    #[test]
    fn what_nobody_builds_any_more_is_removed() {
        let (_directory, cache) = cache();
        let [old, new] = ["old", "new"].map(|name| cache.root.join(format!("{BUILDING}{name}")));
        for directory in [&old, &new] {
            std::fs::create_dir_all(directory).unwrap();
            std::fs::write(directory.join("main.rs"), "").unwrap();
        }
        let long_ago = std::time::SystemTime::now() - ABANDONED - Duration::from_secs(60);
        let file = std::fs::File::open(&old).unwrap();
        // some systems cannot set the time of a directory
        let set = file.set_modified(long_ago);
        assert!(set.is_ok() || !cfg!(unix), "{set:?}");
        cache.entry("a", "model", fill).unwrap();
        assert!(old.exists() != set.is_ok() && new.exists());
    }

    #[test]
    fn the_environment_says_where() {
        let of = |set: &[(&str, &str)]| {
            let set: Vec<(String, String)> = set
                .iter()
                .map(|(a, b)| (a.to_string(), b.to_string()))
                .collect();
            let variable = |name: &str| {
                set.iter()
                    .find(|(n, _)| n == name)
                    .map(|(_, v)| PathBuf::from(v))
            };
            Cache::of(variable).map(|cache| cache.root)
        };
        let absolute = if cfg!(windows) { "C:/x" } else { "/x" };
        let all = [
            ("BRYANT_CACHE", "here"),
            ("XDG_CACHE_HOME", absolute),
            ("HOME", "/h"),
        ];
        assert_eq!(of(&all).unwrap(), PathBuf::from("here"));
        assert_eq!(of(&all[1..]).unwrap(), Path::new(absolute).join("bryant"));
        assert!(matches!(of(&[]), Err(BuildError::NoCache)));
    }
}
