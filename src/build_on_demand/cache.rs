//! A cache directory of finished entries: an entry is complete, or it does not exist.

use super::BuildError;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Prefix of the names of directories that are being filled.
const BUILDING: &str = ".building-";
/// A directory that is this old is not being filled any more.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// Where compiled models are kept.
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
        let home = if cfg!(windows) {
            variable("LOCALAPPDATA")
        } else if cfg!(target_os = "macos") {
            variable("HOME").map(|home| home.join("Library/Caches"))
        } else {
            variable("HOME").map(|home| home.join(".cache"))
        };
        let root = variable("BRYANT_CACHE")
            // the XDG specification says that relative paths are ignored
            .or_else(|| {
                variable("XDG_CACHE_HOME")
                    .filter(|p| p.is_absolute())
                    .map(under)
            })
            .or_else(|| home.map(under));
        root.map(|root| Self { root }).ok_or(BuildError::NoCache)
    }

    /// The file `file` of an entry; if the entry does not exist, `build` fills a directory that becomes the entry.
    pub fn entry(
        &self,
        name: &str,
        file: &str,
        build: impl FnOnce(&Path) -> Result<(), BuildError>,
    ) -> Result<PathBuf, BuildError> {
        let entry = self.root.join(name);
        let wanted = entry.join(file);
        if wanted.is_file() {
            return Ok(wanted);
        }
        std::fs::create_dir_all(&self.root).map_err(|e| self.fault(e))?;
        self.remove_abandoned();
        let mut prefix = std::ffi::OsString::from(BUILDING);
        prefix.push(name);
        let temporary = tempfile::Builder::new()
            .prefix(&prefix)
            .tempdir_in(&self.root)
            .map_err(|e| self.fault(e))?;
        build(temporary.path())?;
        let built = temporary.keep();
        let Err(error) = std::fs::rename(&built, &entry) else {
            return Ok(wanted);
        };
        // Another run was faster, or an entry without its file is in the way.
        let moved = if wanted.is_file() {
            Ok(())
        } else {
            remove(&entry).and_then(|()| std::fs::rename(&built, &entry))
        };
        if built.exists() {
            // A directory that cannot be removed does no harm: its name is never looked for.
            let _ = remove(&built);
        }
        match moved {
            Ok(()) => Ok(wanted),
            Err(_) if wanted.is_file() => Ok(wanted),
            Err(_) => Err(self.fault(error)),
        }
    }

    /// Removes directories whose building began a day ago or earlier: the process that filled them was ended.
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
                // a directory that cannot be removed does no harm
                let _ = remove(&entry.path());
            }
        }
    }

    /// Keeps the sources and messages of a failure for a report, in the directory `failed`.
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
        // if even this fails, the message still has the first error of the compiler
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
