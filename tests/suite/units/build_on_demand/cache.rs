use bryant::build_on_demand::cache::{ABANDONED, BUILDING, is_safe, seal_of};
use bryant::build_on_demand::{BuildError, Cache};
use std::path::{Path, PathBuf};
use std::time::Duration;

fn cache() -> (tempfile::TempDir, Cache) {
    let directory = tempfile::tempdir().unwrap();
    let root = directory.path().join("cache");
    (directory, Cache { root })
}

fn write(directory: &Path, text: &str) -> Result<(), BuildError> {
    std::fs::write(directory.join("model"), text).unwrap();
    Ok(())
}

fn fill(directory: &Path) -> Result<(), BuildError> {
    write(directory, "program")
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
        write(directory, "other")
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
