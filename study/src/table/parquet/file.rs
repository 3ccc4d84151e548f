//! A file of Apache Parquet by <https://parquet.apache.org/docs/file-format/>, of the simplest kind: no value is
//! missing, and nothing is compressed. A column of a group is one page. Words repeat often, so they are indices into a
//! dictionary.
//!
//! ```text
//! PAR1 | group: column: (dictionary) page … | … | footer | length of the footer | PAR1
//! ```

use super::thrift::{Fields, varint};
use std::io::{self, Write};

const MAGIC: &[u8; 4] = b"PAR1";

// numbers from parquet.thrift
const REQUIRED: i32 = 0;
const UNCOMPRESSED: i32 = 0;
const PLAIN: i32 = 0;
const RLE: i32 = 3;
const RLE_DICTIONARY: i32 = 8;
const DATA_PAGE: i32 = 0;
const DICTIONARY_PAGE: i32 = 2;

/// A column of some rows.
pub struct Column<'a> {
    /// Its name.
    pub name: String,
    /// One value for each row.
    pub values: Values<'a>,
}

/// Values of one type.
pub enum Values<'a> {
    /// Integers.
    Long(Vec<i64>),
    /// Floating-point numbers.
    Double(Vec<f64>),
    /// Integers from 0.
    Count(Vec<u32>),
    /// Text, with at most 65 536 different words.
    Word(Vec<&'a str>),
}

/// A file that is being written.
pub struct File<W> {
    out: W,
    /// Position in the file: number of bytes written so far.
    at: usize,
    rows: usize,
    /// Entries of the footer for the columns.
    schema: Vec<Fields>,
    groups: Vec<Fields>,
}

impl<W: Write> File<W> {
    /// Begins a file with columns of these names and types.
    pub fn new(out: W, name: &str, columns: Vec<Column<'_>>) -> io::Result<File<W>> {
        let root = Fields::default().text(4, name).int(5, columns.len() as i32);
        let columns = columns.iter().map(Column::schema);
        let schema = [root].into_iter().chain(columns).collect();
        let mut file = File {
            out,
            at: 0,
            rows: 0,
            schema,
            groups: Vec::new(),
        };
        file.write(MAGIC)?;
        Ok(file)
    }

    /// Adds rows: all columns of the file, with equally many values.
    pub fn group(&mut self, columns: Vec<Column<'_>>) -> io::Result<()> {
        let start = self.at;
        let rows = columns.first().map_or(0, |column| column.values.len());
        let mut chunks = Vec::new();
        for column in columns {
            chunks.push(self.chunk(column)?);
        }
        self.rows += rows;
        self.groups.push(
            Fields::default()
                .list(1, &chunks)
                .long(2, (self.at - start) as i64)
                .long(3, rows as i64),
        );
        Ok(())
    }

    /// Ends the file.
    pub fn close(mut self, metadata: &[(&str, String)]) -> io::Result<()> {
        let pair = |(key, value): &(&str, String)| Fields::default().text(1, key).text(2, value);
        let metadata: Vec<Fields> = metadata.iter().map(pair).collect();
        let footer = Fields::default()
            .int(1, 1)
            .list(2, &self.schema)
            .long(3, self.rows as i64)
            .list(4, &self.groups)
            .list(5, &metadata)
            .text(6, "bryant")
            .finish();
        self.write(&footer)?;
        self.write(&(footer.len() as u32).to_le_bytes())?;
        self.write(MAGIC)
    }

    /// Writes a column of a group, and returns its entry for the footer.
    fn chunk(&mut self, column: Column<'_>) -> io::Result<Fields> {
        let start = self.at;
        let count = column.values.len();
        let (encoding, dictionary, values) = column.values.encoded();
        if let Some(words) = &dictionary {
            let mut bytes = Vec::new();
            for word in words {
                bytes.extend((word.len() as u32).to_le_bytes());
                bytes.extend(word.as_bytes());
            }
            let header = Fields::default().int(1, words.len() as i32).int(2, PLAIN);
            self.page(DICTIONARY_PAGE, 7, header, &bytes)?;
        }
        let page = self.at;
        let header = Fields::default()
            .int(1, count as i32)
            .int(2, encoding)
            .int(3, RLE)
            .int(4, RLE);
        self.page(DATA_PAGE, 5, header, &values)?;
        let size = (self.at - start) as i64;
        let mut encodings = vec![encoding];
        encodings.extend(dictionary.is_some().then_some(PLAIN));
        let mut about = Fields::default()
            .int(1, column.values.physical())
            .list(2, &encodings)
            .list(3, &[column.name.as_str()])
            .int(4, UNCOMPRESSED)
            .long(5, count as i64)
            .long(6, size)
            .long(7, size)
            .long(9, page as i64);
        if dictionary.is_some() {
            about = about.long(11, start as i64);
        }
        Ok(Fields::default().long(2, start as i64).fields(3, about))
    }

    fn page(&mut self, kind: i32, id: u8, header: Fields, bytes: &[u8]) -> io::Result<()> {
        let size = bytes.len() as i32;
        let header = Fields::default()
            .int(1, kind)
            .int(2, size)
            .int(3, size)
            .fields(id, header)
            .finish();
        self.write(&header)?;
        self.write(bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.at += bytes.len();
        self.out.write_all(bytes)
    }
}

impl Column<'_> {
    fn schema(&self) -> Fields {
        let schema = Fields::default()
            .int(1, self.values.physical())
            .int(3, REQUIRED)
            .text(4, &self.name);
        // The logical type is stored twice: for readers before format 2.4, and for later ones.
        match self.values {
            Values::Long(_) | Values::Double(_) => schema,
            Values::Word(_) => {
                let text = Fields::default().fields(1, Fields::default());
                schema.int(6, 0).fields(10, text)
            }
            Values::Count(_) => {
                let unsigned = Fields::default().byte(1, 32).no(2);
                let whole = Fields::default().fields(10, unsigned);
                schema.int(6, 13).fields(10, whole)
            }
        }
    }
}

impl<'a> Values<'a> {
    fn len(&self) -> usize {
        match self {
            Values::Long(values) => values.len(),
            Values::Double(values) => values.len(),
            Values::Count(values) => values.len(),
            Values::Word(values) => values.len(),
        }
    }

    /// The number of the physical type.
    fn physical(&self) -> i32 {
        match self {
            Values::Count(_) => 1,
            Values::Long(_) => 2,
            Values::Double(_) => 5,
            Values::Word(_) => 6,
        }
    }

    /// The number of the encoding, the words of the dictionary if there is one, and the bytes.
    fn encoded(&self) -> (i32, Option<Vec<&'a str>>, Vec<u8>) {
        let plain = |bytes: Vec<u8>| (PLAIN, None, bytes);
        match self {
            Values::Long(values) => plain(values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Values::Double(values) => plain(values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Values::Count(values) => plain(values.iter().flat_map(|x| x.to_le_bytes()).collect()),
            Values::Word(values) => {
                let mut words: Vec<&'a str> = Vec::new();
                let mut runs = Vec::new();
                for run in values.chunk_by(|a, b| a == b) {
                    let known = words.iter().position(|word| *word == run[0]);
                    let number = known.unwrap_or_else(|| {
                        words.push(run[0]);
                        words.len() - 1
                    });
                    runs.push((run.len() as u64, number as u16));
                }
                // all indices have the same number of bits, in whole bytes; each run repeats one index, and begins with
                // twice its length
                let size = if words.len() <= 256 { 1 } else { 2 };
                let mut bytes = vec![8 * size as u8];
                for (length, number) in runs {
                    varint(&mut bytes, 2 * length);
                    bytes.extend(&number.to_le_bytes()[..size]);
                }
                (RLE_DICTIONARY, Some(words), bytes)
            }
        }
    }
}
