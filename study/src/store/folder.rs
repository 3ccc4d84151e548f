//! The folder of results. It belongs to one study; its blocks are read and written here.

use super::identity::{Identity, Program};
use super::part::{self, PartError};
use super::write::{UNFINISHED, WriteError, at, replace};
use crate::engine::Outcomes;
use crate::shard::Shard;
use crate::study::Study;
use bryant_generator::description::load::read_bytes;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Largest size of a file in a folder of results in bytes: 4096 rows with 30 000 responses each.
pub const MOST_BYTES: u64 = 1 << 30;

/// Results of one study, in one folder.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    identity: Identity,
    responses: usize,
}

/// Prefix and suffix of the names of the lock files of shards.
const LOCK: [&str; 2] = ["shard-", ".lock"];

/// The division of the rows into blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocks {
    /// Rows of the study.
    pub rows: u64,
    /// Rows of a block; the last block has the remaining rows.
    pub size: u64,
}

impl Blocks {
    /// Number of blocks.
    pub fn count(self) -> u64 {
        self.rows.div_ceil(self.size)
    }

    /// Rows of a block.
    pub fn rows(self, block: u64) -> Range<u64> {
        let first = block * self.size;
        first..(first + self.size).min(self.rows)
    }
}

/// A block in the folder.
#[derive(Clone, Debug, PartialEq)]
pub enum Found {
    /// The block is complete.
    Good(Outcomes),
    /// The block is missing.
    Missing,
    /// The file is not a valid block.
    Bad(PartError),
}

/// Why a folder cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The folder has results of another study.
    #[error(
        "{} holds results of something else\n  there: {there}\n  here:  {here}\n  differs: {}\n  help: {}",
        .path.display(), .differs.join(", "), .help
    )]
    Other {
        /// The folder.
        path: PathBuf,
        /// Identity of the existing results.
        there: String,
        /// Identity of the requested results.
        here: String,
        /// The differences.
        differs: Vec<String>,
        /// The remedy.
        help: &'static str,
    },
    /// The folder is used for something else.
    #[error(
        "{} is not a folder of results, and not empty\n  help: name a new folder, or an empty one", .0.display()
    )]
    Foreign(PathBuf),
    /// Another process works in the folder or the shard.
    #[error(
        "{} is in use: another `bryant sweep` or `bryant merge` works in this folder\n  \
         help: wait until it ends, or name another folder by --out; shards of one study may run at once, each by its own --shard I/N", .0.display()
    )]
    Busy(PathBuf),
    /// `study.json` was not written by this program.
    #[error("{} cannot be understood: {reason}\n  help: name another folder; if nothing else is in this one, remove it", .path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: String,
    },
    /// A file or folder cannot be read.
    #[error("cannot read {}: {source}", .path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl Folder {
    /// Opens the folder for a study, and creates it if it does not exist.
    ///
    /// # Errors
    /// The folder belongs to another study or to something else, or it cannot be read or written.
    pub fn open(path: &Path, study: &Study, program: &Program) -> Result<Folder, FolderError> {
        let file = path.join("study.json");
        let unreadable = |reason: String| FolderError::Unreadable {
            path: file.clone(),
            reason,
        };
        let identity = Identity::of(study, program).map_err(|e| unreadable(e.to_string()))?;
        match read_bytes(&file, MOST_BYTES) {
            Ok(bytes) => {
                let there: Identity =
                    serde_json::from_slice(&bytes).map_err(|e| unreadable(e.to_string()))?;
                same(path, &there, &identity)?;
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                refuse_foreign(path)?;
                at(path, fs::create_dir_all(path))?;
                let text = serde_json::to_string_pretty(&identity)
                    .map_err(|e| unreadable(e.to_string()))?;
                replace(&file, |out| -> Result<(), WriteError> {
                    at(&file, writeln!(out, "{text}"))
                })?;
            }
            // on Windows, other processes cannot even read a locked file
            Err(source) if cfg!(windows) && source.raw_os_error() == Some(LOCK_VIOLATION) => {
                return Err(FolderError::Busy(path.to_owned()));
            }
            Err(source) => return Err(FolderError::Read { path: file, source }),
        }
        at(path, fs::create_dir_all(path.join("blocks")))?;
        Ok(Folder {
            path: path.to_owned(),
            identity,
            responses: study.responses.len(),
        })
    }

    /// Locks a shard, or the whole folder, for this process. The lock ends when the result is dropped or the process
    /// ends in any way, because the operating system keeps it. If the file system has no locks, nothing is locked. The
    /// lock file of a shard is removed at the end.
    ///
    /// # Errors
    /// Another process has locked the shard or the folder.
    pub fn lock(&self, shard: Shard) -> Result<Lock, FolderError> {
        let busy = |_| FolderError::Busy(self.path.clone());
        let whole = shard == Shard::WHOLE;
        let study = locked(&self.path.join("study.json"), !whole).map_err(busy)?;
        let mut shards = None;
        if !whole {
            let of = shard.to_string().replace('/', "-of-");
            let name = [LOCK[0], &of, LOCK[1]].concat();
            let path = self.path.join("blocks").join(name);
            shards = locked(&path, false).map_err(busy)?.map(|file| (path, file));
        }
        Ok(Lock {
            _study: study,
            shard: shards,
        })
    }

    /// The path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The identity of its results.
    pub fn identity(&self) -> &Identity {
        &self.identity
    }

    /// The division of its rows into blocks.
    pub fn blocks(&self) -> Blocks {
        Blocks {
            rows: self.identity.rows,
            size: self.identity.block,
        }
    }

    /// The file of a block.
    pub fn block_path(&self, block: u64) -> PathBuf {
        self.path.join("blocks").join(format!("{block:08}.part"))
    }

    /// True if the file of a block exists, valid or damaged.
    pub fn has(&self, block: u64) -> bool {
        self.block_path(block).is_file()
    }

    /// Reads a block.
    ///
    /// # Errors
    /// A file exists but cannot be read.
    pub fn read(&self, block: u64) -> Result<Found, FolderError> {
        let path = self.block_path(block);
        let bytes = match read_bytes(&path, MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Found::Missing),
            Err(source) => return Err(FolderError::Read { path, source }),
        };
        let rows = self.blocks().rows(block);
        let count = (rows.end - rows.start) as usize;
        let identity = &self.identity.identity;
        Ok(
            match part::decode(&bytes, identity, rows.start, count, self.responses) {
                Ok(outcomes) => Found::Good(outcomes),
                Err(error) => Found::Bad(error),
            },
        )
    }

    /// Stores a block.
    ///
    /// # Errors
    /// The disk is full, or the folder is gone.
    pub fn write(&self, block: u64, outcomes: &Outcomes) -> Result<(), WriteError> {
        let first = self.blocks().rows(block).start;
        let bytes = part::encode(&self.identity.identity, first, outcomes);
        let path = self.block_path(block);
        replace(&path, |out| at(&path, out.write_all(&bytes)))
    }

    /// Removes unfinished files and lock files of processes that were ended. The whole folder must be
    /// [locked](Folder::lock), because files that are being written would be removed, too.
    ///
    /// # Errors
    /// A folder cannot be read, or a file cannot be removed.
    pub fn tidy(&self) -> Result<(), FolderError> {
        for directory in [
            self.path.clone(),
            self.path.join("blocks"),
            self.path.join("series"),
            self.path.join("study"),
        ] {
            let entries = match fs::read_dir(&directory) {
                Ok(entries) => entries,
                Err(error) if error.kind() == io::ErrorKind::NotFound => continue,
                Err(source) => {
                    return Err(FolderError::Read {
                        path: directory,
                        source,
                    });
                }
            };
            for entry in entries {
                let entry = entry.map_err(|source| FolderError::Read {
                    path: directory.clone(),
                    source,
                })?;
                let name = entry.file_name();
                let name = name.to_string_lossy();
                let of_lock = name.starts_with(LOCK[0]) && name.ends_with(LOCK[1]);
                if name.starts_with(UNFINISHED) || of_lock {
                    at(&entry.path(), fs::remove_file(entry.path()))?;
                }
            }
        }
        Ok(())
    }
}

/// The locks that [`Folder::lock`] has set.
#[derive(Debug)]
pub struct Lock {
    _study: Option<fs::File>,
    /// The lock file of a shard, and its path.
    shard: Option<(PathBuf, fs::File)>,
}

impl Drop for Lock {
    fn drop(&mut self) {
        if let Some((path, _file)) = &self.shard {
            // the file is removed while it is locked; if it remains, it does no harm
            let _ = fs::remove_file(path);
        }
    }
}

/// Error: another process has locked the file.
struct Locked;

/// Error number of Windows for reading a file that another process has locked.
const LOCK_VIOLATION: i32 = 33;

/// Largest number of attempts to lock a file. An attempt fails if the file was removed between opening and locking it;
/// on file systems whose files cannot be told apart, every attempt would fail.
const TRIES: usize = 16;

/// Opens a file and locks it, alone or `shared`. `None` if the file cannot be written, or the file system has no locks.
fn locked(path: &Path, shared: bool) -> Result<Option<fs::File>, Locked> {
    let mut options = fs::OpenOptions::new();
    options.write(true).create(true).truncate(false);
    for _ in 0..TRIES {
        let Ok(file) = options.open(path) else {
            return Ok(None);
        };
        let tried = match shared {
            true => file.try_lock_shared(),
            false => file.try_lock(),
        };
        match tried {
            Ok(()) if is_at(&file, path) => return Ok(Some(file)),
            // the last owner of the lock removed the file after we had opened it: try again
            Ok(()) => {}
            Err(fs::TryLockError::WouldBlock) => return Err(Locked),
            // there may be file systems without locks
            Err(fs::TryLockError::Error(_)) => return Ok(None),
        }
    }
    Ok(None)
}

/// True if an open file is the one at `path`.
#[cfg(unix)]
fn is_at(file: &fs::File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let one = |found: io::Result<fs::Metadata>| found.ok().map(|of| (of.dev(), of.ino()));
    match (one(file.metadata()), one(fs::metadata(path))) {
        (Some(ours), Some(there)) => ours == there,
        _ => false,
    }
}

/// True if an open file is the one at `path`.
#[cfg(windows)]
fn is_at(file: &fs::File, path: &Path) -> bool {
    let one = |file: io::Result<fs::File>| index(&file.ok()?);
    match (index(file), one(fs::File::open(path))) {
        (Some(ours), Some(there)) => ours == there,
        _ => false,
    }
}

/// The volume of a file, and the number of the file on it.
#[cfg(windows)]
#[expect(unsafe_code, reason = "the standard library does not tell it yet")]
fn index(file: &fs::File) -> Option<[u32; 3]> {
    use std::os::windows::io::AsRawHandle;
    use windows_sys::Win32::Storage::FileSystem::{
        BY_HANDLE_FILE_INFORMATION, GetFileInformationByHandle,
    };
    let mut about = BY_HANDLE_FILE_INFORMATION::default();
    // SAFETY: the handle is open, and `about` has room for the result.
    let told = unsafe { GetFileInformationByHandle(file.as_raw_handle(), &raw mut about) };
    let numbers = [
        about.dwVolumeSerialNumber,
        about.nFileIndexHigh,
        about.nFileIndexLow,
    ];
    (told != 0).then_some(numbers)
}

/// True if there is a file at `path`; this system cannot tell whether it is the open one.
#[cfg(not(any(unix, windows)))]
fn is_at(_: &fs::File, path: &Path) -> bool {
    path.exists()
}

/// The parts of a study that affect its results: their keys in `study.json`, and their names for a user.
const PARTS: [(&str, &str); 6] = [
    ("rows", "the number of runs"),
    ("varied", "the parameters that are varied"),
    ("fixed", "the parameters that are set"),
    ("plan", "the values of the parameters"),
    ("run", "the run"),
    ("responses", "the responses"),
];

/// Refuses results of another identity, and names the differences.
fn same(path: &Path, there: &Identity, here: &Identity) -> Result<(), FolderError> {
    let mut differs: Vec<String> = Vec::new();
    let mut differ = |is: bool, what: &str| {
        if is {
            differs.push(what.into());
        }
    };
    let of_study = || {
        let parts = PARTS.into_iter();
        let parts = parts.filter(|(key, _)| there.study.get(key) != here.study.get(key));
        let words: Vec<&str> = parts.map(|(_, word)| word).collect();
        match words.as_slice() {
            [] => "the study".to_owned(),
            words => format!("the study ({})", words.join(", ")),
        }
    };
    let other_study = there.study != here.study;
    differ(other_study, &of_study());
    differ(there.model != here.model, "the model");
    differ(there.version != here.version, "the version of the program");
    differ(there.arithmetic != here.arithmetic, "the arithmetic");
    if there.identity == here.identity && (there.rows, there.block) == (here.rows, here.block) {
        return Ok(());
    }
    if differs.is_empty() {
        differs.push("how responses are read off runs, or results kept, in this version".into());
    }
    let help = if other_study && differs.len() == 1 {
        "name another folder, or restore the study as it was when these results were made (see its `study.json`)"
    } else {
        "name another folder; these results are completed by the program and the model that began them"
    };
    Err(FolderError::Other {
        path: path.to_owned(),
        there: there.identity.clone(),
        here: here.identity.clone(),
        differs,
        help,
    })
}

/// A folder without `study.json` is accepted only if it contains no other files.
fn refuse_foreign(path: &Path) -> Result<(), FolderError> {
    let read = |source| FolderError::Read {
        path: path.to_owned(),
        source,
    };
    let entries = match fs::read_dir(path) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => return Err(read(source)),
    };
    for entry in entries {
        let name = entry.map_err(read)?.file_name();
        let name = name.to_string_lossy();
        // another process may be opening the folder at the same time
        if name != "blocks" && name != "study.json" && !name.starts_with(UNFINISHED) {
            return Err(FolderError::Foreign(path.to_owned()));
        }
    }
    Ok(())
}
