//! Tells the program the commit that it is built from ("unknown" where nothing says it), and puts the texts of the
//! bundled models into it.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Digits of a commit that are told.
const DIGITS: usize = 12;

fn main() -> std::io::Result<()> {
    tell_commit();
    list_models()
}

/// Writes the table of all files in `models/`, by their paths in it.
fn list_models() -> std::io::Result<()> {
    let models = std::path::absolute("models")?;
    let mut files = Vec::new();
    collect(&models, &mut files)?;
    files.sort();
    let mut table = String::from("&[\n");
    for file in &files {
        let name = file.strip_prefix(&models).unwrap_or(file);
        let name = name.to_string_lossy().replace('\\', "/");
        let place = file.display().to_string();
        let _ = writeln!(table, "    ({name:?}, include_str!({place:?})),");
    }
    table.push(']');
    let out = std::env::var_os("OUT_DIR").unwrap_or_default();
    std::fs::write(Path::new(&out).join("models.rs"), table)
}

/// Collects the files of a directory and of its subdirectories.
fn collect(directory: &Path, files: &mut Vec<PathBuf>) -> std::io::Result<()> {
    println!("cargo::rerun-if-changed={}", directory.display());
    for entry in std::fs::read_dir(directory)? {
        let path = entry?.path();
        let known = path.extension().is_some_and(|e| e == "yaml" || e == "rs");
        if path.is_dir() {
            collect(&path, files)?;
        } else if known {
            files.push(path);
        }
    }
    Ok(())
}

/// The commit: that of the repository, or, in a package, the one that cargo wrote into it.
fn tell_commit() {
    println!("cargo::rerun-if-changed=build.rs");
    let commit = of_repository().or_else(of_package);
    println!(
        "cargo::rustc-env=BRYANT_COMMIT={}",
        commit.as_deref().unwrap_or("unknown")
    );
}

fn of_repository() -> Option<String> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // a package inside of another repository has no commit of its own
    let here = std::env::current_dir().and_then(std::fs::canonicalize);
    let top = std::fs::canonicalize(git(&["rev-parse", "--show-toplevel"])?);
    if here.ok()? != top.ok()? {
        return None;
    }
    // Every commit and every change of branch writes to one of these files. Of a file that does not exist cargo would
    // always say that it has changed.
    let branch = git(&["symbolic-ref", "--quiet", "HEAD"]);
    for file in ["HEAD", "logs/HEAD", "packed-refs"]
        .into_iter()
        .chain(branch.as_deref())
    {
        if let Some(path) = git(&["rev-parse", "--git-path", file])
            && Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    git(&["rev-parse", &format!("--short={DIGITS}"), "HEAD"])
}

fn of_package() -> Option<String> {
    let about = std::fs::read_to_string(".cargo_vcs_info.json").ok()?;
    println!("cargo::rerun-if-changed=.cargo_vcs_info.json");
    let (_, rest) = about.split_once("\"sha1\": \"")?;
    let commit = rest.get(..DIGITS)?;
    commit
        .bytes()
        .all(|b| b.is_ascii_hexdigit())
        .then(|| commit.to_owned())
}
