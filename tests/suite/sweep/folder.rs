//! A folder of results, as bytes and as a table.

use std::collections::BTreeMap;
use std::path::Path;

/// Every file of a folder by its path in it.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    add(folder, "", &mut files);
    files
}

fn add(folder: &Path, before: &str, files: &mut BTreeMap<String, Vec<u8>>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{before}{}", entry.file_name().to_string_lossy());
        if entry.file_type().unwrap().is_dir() {
            add(&entry.path(), &format!("{name}/"), files);
        } else {
            files.insert(name, std::fs::read(entry.path()).unwrap());
        }
    }
}

/// Expects two folders to hold the same files with the same bytes.
#[track_caller]
pub fn assert_same(one: &Path, other: &Path) {
    let (one, other) = (files(one), files(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, bytes) in &one {
        assert!(bytes == &other[name], "{name} differs");
    }
}

/// A CSV file: its headings, and its rows as they are written.
pub struct Table {
    headings: Vec<String>,
    /// The cells, row by row.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// The table of a CSV text.
    pub fn of(text: &str) -> Table {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let fields = |record: &csv::StringRecord| record.iter().map(str::to_owned).collect();
        Table {
            headings: fields(reader.headers().unwrap()),
            rows: reader.records().map(|r| fields(&r.unwrap())).collect(),
        }
    }

    /// The table of a file.
    pub fn read(path: &Path) -> Table {
        Table::of(&std::fs::read_to_string(path).unwrap())
    }

    fn column(&self, heading: &str) -> usize {
        let found = self.headings.iter().position(|h| h == heading);
        found.unwrap_or_else(|| panic!("no {heading} in {:?}", self.headings))
    }

    /// The cells of a column.
    pub fn words(&self, heading: &str) -> Vec<&str> {
        let column = self.column(heading);
        self.rows.iter().map(|row| row[column].as_str()).collect()
    }

    /// The numbers of a column.
    pub fn numbers(&self, heading: &str) -> Vec<f64> {
        let number = |word: &str| word.parse().unwrap_or_else(|_| panic!("\"{word}\""));
        self.words(heading).into_iter().map(number).collect()
    }
}
