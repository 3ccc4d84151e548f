//! The shared libraries that FMUs carry.

use super::Error;
use bryant_fmu::Version;
use std::path::{Path, PathBuf};

/// A shared library of one platform.
pub struct Library {
    /// The content of its file.
    pub content: Vec<u8>,
    of: &'static Platform,
}

/// A platform: a processor and a system.
pub struct Platform {
    /// Its name in FMI 3.0.
    pub name: &'static str,
    /// Its name in FMI 2.0.
    in_two: &'static str,
    ending: &'static str,
    /// The format of its files, and their number of the processor.
    recognised: (Format, u32),
}

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Elf,
    Portable,
    Mach,
}

const fn platform(
    name: &'static str,
    in_two: &'static str,
    format: Format,
    processor: u32,
) -> Platform {
    let ending = match format {
        Format::Elf => "so",
        Format::Portable => "dll",
        Format::Mach => "dylib",
    };
    Platform {
        name,
        in_two,
        ending,
        recognised: (format, processor),
    }
}

/// Names of FMI 2.0 exist for processors of Intel only; importers for others look for those of 3.0.
const PLATFORMS: [Platform; 6] = [
    platform("x86_64-linux", "linux64", Format::Elf, 62),
    platform("aarch64-linux", "aarch64-linux", Format::Elf, 183),
    platform("x86_64-windows", "win64", Format::Portable, 0x8664),
    platform(
        "aarch64-windows",
        "aarch64-windows",
        Format::Portable,
        0xaa64,
    ),
    platform("x86_64-darwin", "darwin64", Format::Mach, 0x0100_0007),
    platform(
        "aarch64-darwin",
        "aarch64-darwin",
        Format::Mach,
        0x0100_000c,
    ),
];

/// The name of the library of this platform.
const OWN: &str = match (cfg!(windows), cfg!(target_os = "macos")) {
    (true, _) => "bryant_fmi.dll",
    (_, true) => "libbryant_fmi.dylib",
    _ => "libbryant_fmi.so",
};

impl Library {
    /// The libraries in these files; the one beside this program if there are none.
    ///
    /// # Errors
    /// A file that cannot be read or is no shared library of FMUs; two for one platform.
    pub fn all(files: &[PathBuf]) -> Result<Vec<Self>, Error> {
        let own;
        let files = match files {
            [] => {
                own = [beside_program()?];
                &own[..]
            }
            files => files,
        };
        let mut all: Vec<Library> = Vec::new();
        for file in files {
            let library = Self::read(file)?;
            if all.iter().any(|other| other.of.name == library.of.name) {
                return Err(Error::Input(format!(
                    "there are two libraries for {}\n  help: name one of them",
                    library.of.name
                )));
            }
            all.push(library);
        }
        Ok(all)
    }

    fn read(path: &Path) -> Result<Self, Error> {
        let content = std::fs::read(path)
            .map_err(|error| Error::Input(format!("cannot read {}: {error}", path.display())))?;
        let has = |text: &[u8]| content.windows(text.len()).any(|part| part == text);
        let of = recognised(&content).filter(|_| has(b"fmi2DoStep") && has(b"fmi3DoStep"));
        let of = of.ok_or_else(|| {
            Error::Input(format!(
                "{} is no library of FMUs\n  help: name the file {OWN} that `cargo build --release -p bryant-fmi` makes, or one of another platform",
                path.display()
            ))
        })?;
        Ok(Library { content, of })
    }

    /// The name of its platform, as in FMI 3.0.
    pub fn platform(&self) -> &'static str {
        self.of.name
    }

    /// Its place in an FMU.
    pub fn place(&self, version: Version, identifier: &str) -> String {
        let folder = match version {
            Version::Two => self.of.in_two,
            Version::Three => self.of.name,
        };
        format!("binaries/{folder}/{identifier}.{}", self.of.ending)
    }
}

/// The platform of a shared library, by its first bytes.
pub fn recognised(content: &[u8]) -> Option<&'static Platform> {
    let number = |at: usize, bytes: usize| -> Option<u32> {
        let number = content.get(at..at.checked_add(bytes)?)?;
        Some(
            number
                .iter()
                .rev()
                .fold(0, |sum, byte| sum << 8 | u32::from(*byte)),
        )
    };
    let of = match content.get(..4)? {
        b"\x7fELF" => (Format::Elf, number(18, 2)?),
        [b'M', b'Z', ..] => (Format::Portable, number(number(60, 4)? as usize + 4, 2)?),
        [0xcf, 0xfa, 0xed, 0xfe] => (Format::Mach, number(4, 4)?),
        _ => return None,
    };
    PLATFORMS.iter().find(|platform| platform.recognised == of)
}

/// The library that was built or installed with this program: beside it, or where cargo builds it.
fn beside_program() -> Result<PathBuf, Error> {
    let program = std::env::current_exe().map_err(Error::system)?;
    let program = program.canonicalize().unwrap_or(program);
    let folder = program.parent().unwrap_or(Path::new("."));
    let places = [folder.join(OWN), folder.join("deps").join(OWN)];
    let found = places.into_iter().find(|place| place.is_file());
    found.ok_or_else(|| {
        Error::Input(format!(
            "{OWN}, which an FMU carries, is not beside {}\n  help: in the sources, `cargo build --release -p bryant-fmi` makes it; name it by --library, or copy it there",
            program.display()
        ))
    })
}
