//! Finds and calls the Rust compiler, and explains its failures.

use super::message::Messages;
use super::{BuildError, Cache, Text};
use sha2::{Digest, Sha256};
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Output};

/// A compiler that answered.
#[derive(Clone, Debug)]
pub struct Rustc {
    command: OsString,
    /// Version, commit and host of the compiler, and features of this machine's processor.
    identity: String,
    processor: Processor,
}

/// The processors that compiled code can run on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Processor {
    /// Only processors like that of this machine, with all of its instructions; this speed is mostly the reason to
    /// compile here.
    This,
    /// All processors of this architecture; code for other instructions checks for them when it runs.
    Any,
}

impl Processor {
    fn option(self) -> &'static str {
        match self {
            Processor::This => "-Ctarget-cpu=native",
            Processor::Any if cfg!(target_arch = "x86_64") => "-Ctarget-cpu=x86-64",
            Processor::Any => "-Ctarget-cpu=generic",
        }
    }
}

/// Options of every compilation.
const OPTIONS: [&str; 5] = [
    "--edition=2024",
    "-Copt-level=3",
    "-Ccodegen-units=1",
    "-Cdebuginfo=0",
    "--cap-lints=allow",
];

impl Rustc {
    /// `$RUSTC`, else `rustc` on the path.
    pub fn find() -> Result<Self, BuildError> {
        let command = std::env::var_os("RUSTC").filter(|v| !v.is_empty());
        let command = command.unwrap_or_else(|| "rustc".into());
        let version = ask(&command, &["-vV"])?;
        // the features are part of the key, because machines with different processors may share a cache
        let processor = ask(&command, &["--print=cfg", "-Ctarget-cpu=native"])?;
        Ok(Self {
            command,
            identity: version + &processor,
            processor: Processor::This,
        })
    }

    /// Finds the compiler for code that also runs on other machines, or has the same bits there. The features of the
    /// processor are then not known.
    pub fn find_portable() -> Result<Self, BuildError> {
        let command = std::env::var_os("RUSTC").filter(|v| !v.is_empty());
        let command = command.unwrap_or_else(|| "rustc".into());
        Ok(Self {
            identity: ask(&command, &["-vV"])?,
            command,
            processor: Processor::Any,
        })
    }

    /// The same compiler, but for code that also runs on other machines.
    pub fn portable(self) -> Self {
        let processor = Processor::Any;
        Self { processor, ..self }
    }

    /// Its name, version and date: "rustc 1.95.0 (…)".
    pub fn version(&self) -> &str {
        self.identity.lines().next().unwrap_or_default()
    }

    /// Features of this machine's processor that the code uses, sorted.
    pub fn features(&self) -> Vec<String> {
        let feature = |line: &str| {
            let name = line.strip_prefix("target_feature=\"")?.strip_suffix('"')?;
            Some(name.to_owned())
        };
        let mut features: Vec<String> = self.identity.lines().filter_map(feature).collect();
        features.sort();
        features
    }

    /// Key of a result that depends only on this compiler and on the text with this `digest`; other builds of this
    /// program have the same key.
    pub fn key_of_text(&self, digest: &str) -> String {
        let parts = [
            digest,
            env!("CARGO_PKG_VERSION"),
            &self.identity,
            self.processor.option(),
        ];
        self::digest(parts.into_iter().chain(OPTIONS))[..24].to_owned()
    }

    /// Key of a result that depends on `digest`, this program and this compiler: 24 hexadecimal digits.
    pub fn key(&self, digest: &str) -> String {
        let parts = [
            digest,
            env!("CARGO_PKG_VERSION"),
            &program_identity(),
            &self.identity,
            self.processor.option(),
        ];
        self::digest(parts.into_iter().chain(OPTIONS))[..24].to_owned()
    }

    /// Compiles one file with its modules. Errors in the user's texts are reported at the lines of the user's files.
    pub fn compile(
        &self,
        file: &Path,
        options: &[&str],
        to: &Path,
        cache: &Cache,
        (module, texts): (&str, &[Text<'_>]),
    ) -> Result<(), BuildError> {
        let mut command = Command::new(&self.command);
        command
            .args(OPTIONS)
            .arg(self.processor.option())
            .args(options)
            .arg("--error-format=json")
            .arg("-o")
            .arg(to)
            .arg(file);
        // settings of cargo or of a wrapper must not change the result
        command.env_remove("RUSTFLAGS").env_remove("RUSTC_WRAPPER");
        let output = command.output().map_err(|source| BuildError::NoCompiler {
            command: self.command.to_string_lossy().into_owned(),
            source,
        })?;
        if output.status.success() {
            return Ok(());
        }
        let messages = Messages::parse(&String::from_utf8_lossy(&output.stderr));
        if let Some(problems) = messages.in_texts(module, texts) {
            return Err(BuildError::User(problems));
        }
        let message = messages.first_error();
        if message.starts_with("linker `") && message.contains("not found") {
            return Err(BuildError::NoLinker { message });
        }
        let directory = file.parent().unwrap_or(Path::new("."));
        Err(BuildError::Rejected {
            message,
            kept: cache.keep_failure(directory, &messages.text),
        })
    }
}

/// SHA-256 of several texts. The length of each is included, so that lists that are divided differently have different
/// digests.
pub fn digest<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut hasher = Sha256::new();
    for part in parts {
        hasher.update((part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher
        .finalize()
        .iter()
        .map(|b| format!("{b:02x}"))
        .collect()
}

/// A text that differs between builds of this program with the same version, because they may write different
/// equations.
fn program_identity() -> String {
    let file = std::env::current_exe().and_then(std::fs::metadata);
    let Ok(file) = file else {
        return String::new();
    };
    let modified = file.modified().ok();
    let since = modified.and_then(|m| m.duration_since(std::time::UNIX_EPOCH).ok());
    format!("{} {:?}", file.len(), since)
}

pub fn ask(command: &OsString, arguments: &[&str]) -> Result<String, BuildError> {
    let name = || command.to_string_lossy().into_owned();
    let output: Output = Command::new(command)
        .args(arguments)
        .output()
        .map_err(|source| BuildError::NoCompiler {
            command: name(),
            source,
        })?;
    if !output.status.success() {
        let messages = String::from_utf8_lossy(&output.stderr);
        return Err(BuildError::BadCompiler {
            command: name(),
            arguments: arguments.join(" "),
            message: first_error(&messages),
        });
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// The first error among the messages of the compiler, without its context.
pub fn first_error(messages: &str) -> String {
    let error = messages.lines().find_map(|line| {
        let rest = line.strip_prefix("error")?;
        rest.split_once(": ").map(|(_, message)| message)
    });
    let first = error.or_else(|| messages.lines().find(|line| !line.trim().is_empty()));
    first
        .unwrap_or("the compiler printed no message")
        .trim()
        .to_owned()
}
