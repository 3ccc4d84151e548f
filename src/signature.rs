//! Recognises files that this program wrote. Without the user's consent, only such files are replaced.
//!
//! Each file has a mark that other programs ignore: the first heading of a table is in quotation marks although it
//! needs none; pages and animations name their generator; texts of models end with a line that has their checksum.

use sha2::{Digest, Sha256};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

/// The kind of content of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContentKind {
    /// A table of a run or of a study of accuracy, CSV.
    Table,
    /// A table as Apache Parquet.
    Parquet,
    /// A picture, SVG or PNG.
    Picture,
    /// A report, HTML.
    Report,
    /// A page, Markdown.
    Markdown,
    /// An animation, glTF.
    Animation,
    /// A state, JSON.
    State,
    /// The description of a test in ISO-MME; its channels are in a folder beside it.
    Test,
    /// A model or a part of one, YAML.
    Model,
    /// Equations in C.
    Source,
    /// A functional mock-up unit, an archive.
    Fmu,
}

/// The remark on an archive of this program.
pub const ARCHIVE: &str = "bryant";

impl ContentKind {
    /// The extensions of such files; empty if the user does not choose their names.
    pub fn endings(self) -> &'static [&'static str] {
        match self {
            ContentKind::Table => &["csv", "txt", "dat"],
            ContentKind::Parquet => &["parquet"],
            ContentKind::Picture => &["svg", "png"],
            ContentKind::Report => &["html", "htm"],
            ContentKind::Markdown => &["md", "markdown", "txt"],
            ContentKind::Animation => &["glb"],
            ContentKind::State => &["json"],
            ContentKind::Test => &["mme"],
            ContentKind::Model => &["yaml", "yml"],
            ContentKind::Source => &["c", "h"],
            ContentKind::Fmu => &["fmu"],
        }
    }

    /// The kind in words.
    pub fn name(self) -> &'static str {
        match self {
            ContentKind::Table => "a table, CSV",
            ContentKind::Parquet => "Apache Parquet",
            ContentKind::Picture => "a picture, SVG or PNG",
            ContentKind::Report => "a page of HTML",
            ContentKind::Markdown => "Markdown",
            ContentKind::Animation => "binary glTF",
            ContentKind::State => "a state, JSON",
            ContentKind::Test => "ISO-MME",
            ContentKind::Model => "YAML",
            ContentKind::Source => "C",
            ContentKind::Fmu => "an FMU",
        }
    }

    /// True if the extension of a path belongs to another format.
    pub fn contradicts(self, path: &Path) -> bool {
        let Some(ending) = path.extension().and_then(|e| e.to_str()) else {
            return false;
        };
        let ending = ending.to_ascii_lowercase();
        !self.endings().contains(&ending.as_str()) && OF_FORMATS.contains(&ending.as_str())
    }
}

/// Extensions of formats, of this program and of others.
const OF_FORMATS: [&str; 39] = [
    "csv", "tsv", "txt", "dat", "parquet", "svg", "png", "jpg", "jpeg", "gif", "webp", "tif",
    "tiff", "bmp", "eps", "pdf", "html", "htm", "md", "markdown", "glb", "gltf", "obj", "stl",
    "fbx", "mp4", "webm", "json", "yaml", "yml", "toml", "xml", "urdf", "mme", "xls", "xlsx",
    "zip", "rs", "fmu",
];

/// Number of bytes that are read at the beginning of a file; at its end, 1/256 of this number.
const LOOKED_AT: u64 = 1 << 24;
/// The first heading of a table of a run, in each system of units.
const FIRST_HEADINGS: [&str; 2] = ["\"time [s]\"", "\"time [ms]\""];
/// The beginning of the last line of the text of a model.
const SIGNED: &str =
    "# Written by bryant and not changed since, if this is the SHA-256 of the lines above: ";

/// True if replacing the file loses only data that this program wrote: the file is one of this kind from this program,
/// is empty, or does not exist. Also true for a pipe or the like.
///
/// # Errors
/// The file exists and cannot be read.
pub fn may_replace(path: &Path, kind: ContentKind) -> io::Result<bool> {
    if kind == ContentKind::Test {
        return may_replace_test(path);
    }
    let about = match std::fs::metadata(path) {
        Ok(about) => about,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(true),
        Err(error) => return Err(error),
    };
    if !about.is_file() || about.len() == 0 {
        return Ok(true);
    }
    if kind == ContentKind::Model {
        return Ok(std::fs::read(path).is_ok_and(|bytes| is_signed(&bytes)));
    }
    let mut file = File::open(path)?;
    let mut begin = Vec::new();
    (&mut file).take(LOOKED_AT).read_to_end(&mut begin)?;
    let mut end = Vec::new();
    file.seek(SeekFrom::Start(about.len().saturating_sub(LOOKED_AT / 256)))?;
    file.take(LOOKED_AT / 256).read_to_end(&mut end)?;
    Ok(is_own(&begin, &end, kind))
}

fn is_own(begin: &[u8], end: &[u8], kind: ContentKind) -> bool {
    let has = |bytes: &[u8], mark: &str| bytes.windows(mark.len()).any(|w| w == mark.as_bytes());
    let line = begin.split(|b| *b == b'\n').next().unwrap_or_default();
    match kind {
        ContentKind::Table => is_own_heading(line) || has(line, "model digest,bryant,commit"),
        ContentKind::Parquet => begin.starts_with(b"PAR1") && has(end, "bryant"),
        ContentKind::Picture => {
            let svg = begin.starts_with(b"<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"")
                && has(line, "role=\"img\"")
                && has(begin, "</title>\n<style>\ntext{");
            svg || bryant_picture::is_own_png(begin)
        }
        ContentKind::Report => has(begin, "<meta name=\"generator\" content=\"bryant\">"),
        ContentKind::Markdown => {
            begin.starts_with(b"# Hard cases\n") || has(begin, "\n(`bryant accuracy")
        }
        ContentKind::Animation => {
            begin.starts_with(b"glTF") && has(begin, "\"generator\":\"bryant")
        }
        ContentKind::State => {
            begin.starts_with(b"{\n  \"model\": ") && has(begin, "\n  \"coordinates\": {")
        }
        ContentKind::Source => {
            has(begin, "@generated by bryant") || begin.starts_with(b"/* Functions of ")
        }
        // the remark is the end of an archive
        ContentKind::Fmu => begin.starts_with(b"PK") && end.ends_with(ARCHIVE.as_bytes()),
        ContentKind::Test | ContentKind::Model => false,
    }
}

/// True if a line is the heading of a table that a run wrote: the first heading is in quotation marks, the others only
/// if they need them.
pub fn is_own_heading(line: &[u8]) -> bool {
    let Some(rest) = FIRST_HEADINGS
        .iter()
        .find_map(|first| line.strip_prefix(first.as_bytes()))
    else {
        return false;
    };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(rest);
    let Some(Ok(cells)) = reader.byte_records().next() else {
        return rest.is_empty();
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    let written = writer.write_byte_record(&cells).is_ok();
    let again = writer.into_inner().unwrap_or_default();
    written && again.strip_suffix(b"\n") == Some(rest)
}

/// True if a test in ISO-MME may be replaced: its channels say which program made them.
fn may_replace_test(path: &Path) -> io::Result<bool> {
    let folder = path.parent().unwrap_or(Path::new("")).join("Channel");
    let stem = path
        .file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned();
    let channel = folder.join(format!("{stem}.001"));
    match std::fs::read(&channel) {
        Ok(bytes) => {
            Ok(String::from_utf8_lossy(&bytes).contains("\nComments                    :bryant "))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            Ok(!path.exists() && !folder.join(format!("{stem}.chn")).exists())
        }
        Err(error) => Err(error),
    }
}

/// The text of a model with a last line that shows whether the text was changed later.
pub fn signed(text: &str) -> String {
    format!("{text}{SIGNED}{}\n", checksum(text.as_bytes()))
}

/// True if [`signed`] made this text, and it was not changed.
pub fn is_signed(bytes: &[u8]) -> bool {
    let Some(at) = bytes
        .windows(SIGNED.len())
        .rposition(|w| w == SIGNED.as_bytes())
    else {
        return false;
    };
    let said = String::from_utf8_lossy(&bytes[at + SIGNED.len()..]);
    said.trim_end() == checksum(&bytes[..at])
}

fn checksum(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
