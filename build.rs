//! Tells the program which commit it is built from; "unknown" where there is no repository.

use std::process::Command;

fn main() {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).output().ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    // A package inside of some other repository is no commit of that.
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
    // Every commit and every change of branch is written there.
    for file in ["HEAD", "logs/HEAD"] {
        if let Some(path) = git(&["rev-parse", "--git-path", file]).filter(|_| own)
            && std::path::Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}
