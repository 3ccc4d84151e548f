//! Archives: a ZIP file whose bytes depend on its contents alone.

use crate::signature::ARCHIVE;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// An archive that is being written, in memory.
pub struct Archive(ZipWriter<Cursor<Vec<u8>>>);

impl Archive {
    /// An empty one.
    pub fn new() -> Self {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        // one that fits in an archive
        let _ = writer.set_comment(ARCHIVE);
        Archive(writer)
    }

    /// Adds a file.
    pub fn add(&mut self, name: &str, content: &[u8]) {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644);
        let begun = self.0.start_file(name, options);
        let written = begun
            .map_err(std::io::Error::from)
            .and_then(|()| self.0.write_all(content));
        written.unwrap_or_else(|error| unreachable!("memory takes everything: {error}"));
    }

    /// The bytes of the archive.
    pub fn finish(self) -> Vec<u8> {
        let done = self.0.finish();
        done.unwrap_or_else(|error| unreachable!("memory takes everything: {error}"))
            .into_inner()
    }
}
