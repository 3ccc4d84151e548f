//! Tells the program the commit that it is built from ("unknown" without a repository), and puts the texts of the bundled models into it.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

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

fn tell_commit() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // a package inside of another repository has no commit of its own
    let here = std::env::current_dir().and_then(std::fs::canonicalize).ok();
    let top =
        git(&["rev-parse", "--show-toplevel"]).and_then(|top| std::fs::canonicalize(top).ok());
    let own = here.is_some() && here == top;
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).filter(|_| own);
    println!(
        "cargo::rustc-env=BRYANT_COMMIT={}",
        commit.as_deref().unwrap_or("unknown")
    );
    println!("cargo::rerun-if-changed=build.rs");
    // every commit and every change of branch writes to these files
    for file in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]).filter(|_| own)
            && std::path::Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}
