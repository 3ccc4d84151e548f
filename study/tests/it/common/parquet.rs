//! A reader of plain Parquet files that shares no code with their writer. It follows the pages of the format
//! (<https://parquet.apache.org/docs/file-format/>), its parquet.thrift and the compact protocol of Thrift.

use std::collections::BTreeMap;

/// The content of a file.
pub struct Table {
    /// The name of the program that wrote it.
    pub created_by: String,
    /// Keys and values.
    pub metadata: BTreeMap<String, String>,
    /// Names and cells, from the first row to the last.
    pub columns: Vec<(String, Vec<Cell>)>,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    Count(u32),
    Long(i64),
    Double(f64),
    Text(String),
}

/// Reads a file.
pub fn read(file: &[u8]) -> Table {
    let (magic, end) = (b"PAR1".as_slice(), file.len() - 8);
    assert_eq!((&file[..4], &file[end + 4..]), (magic, magic));
    let length = u32::from_le_bytes(file[end..end + 4].try_into().unwrap()) as usize;
    let mut footer = &file[end - length..end];
    let footer = structure(&mut footer);
    let schema = footer[&2].list();
    let (root, schema) = schema.split_first().unwrap();
    assert_eq!(root[5].int(), schema.len() as i64);
    let mut columns = Vec::new();
    for (index, column) in schema.iter().enumerate() {
        assert_eq!(column[3].int(), 0, "every value is there");
        let kind = column[1].int();
        // the old UINT_32 and UTF8, and the new types: an unsigned integer of 32 bits, and a text
        match kind {
            1 => {
                assert_eq!(column[6].int(), 13);
                assert_eq!((column[10][10][1].int(), column[10][10][2].int()), (32, 0));
            }
            6 => {
                assert_eq!(column[6].int(), 0);
                assert!(matches!(&column[10][1], Value::Structure(_)));
            }
            _ => {}
        }
        let mut cells = Vec::new();
        for group in footer[&4].list() {
            let about = &group[1].list()[index][3];
            assert_eq!((about[1].int(), about[4].int()), (kind, 0));
            assert_eq!(about[3].list()[0].text(), column[4].text());
            let before = cells.len();
            cells.extend(chunk(file, about, kind));
            assert_eq!(about[5].int(), group[3].int());
            assert_eq!(cells.len() - before, group[3].int() as usize);
        }
        assert_eq!(cells.len() as i64, footer[&3].int());
        columns.push((column[4].text(), cells));
    }
    let pairs = footer[&5].list().iter();
    Table {
        created_by: footer[&6].text(),
        metadata: pairs.map(|p| (p[1].text(), p[2].text())).collect(),
        columns,
    }
}

/// The cells of one column in a group.
fn chunk(file: &[u8], about: &Value, kind: i64) -> Vec<Cell> {
    let (count, start) = (about[5].int() as usize, about[9].int() as usize);
    let mut page = &file[start..];
    let header = structure(&mut page);
    assert_eq!((header[&1].int(), header[&5][1].int()), (0, count as i64));
    let mut bytes = &page[..header[&3].int() as usize];
    let mut end = start + header[&3].int() as usize + file.len() - start - page.len();
    if kind == 6 {
        let words = dictionary(file, about);
        end -= about[11].int() as usize;
        assert_eq!((take::<1>(&mut bytes), header[&5][2].int()), ([8], 8));
        let mut cells = Vec::new();
        while !bytes.is_empty() {
            let run = varint(&mut bytes);
            assert_eq!(run % 2, 0, "a run, not packed bits");
            let [word] = take(&mut bytes);
            let cell = Cell::Text(words[usize::from(word)].clone());
            cells.resize(cells.len() + run as usize / 2, cell);
        }
        assert_eq!(about[7].int(), end as i64);
        return cells;
    }
    assert_eq!(
        (about[7].int(), header[&5][2].int()),
        ((end - start) as i64, 0)
    );
    let cell = |_| match kind {
        1 => Cell::Count(u32::from_le_bytes(take(&mut bytes))),
        2 => Cell::Long(i64::from_le_bytes(take(&mut bytes))),
        5 => Cell::Double(f64::from_le_bytes(take(&mut bytes))),
        _ => panic!("type {kind}"),
    };
    let cells = (0..count).map(cell).collect();
    assert!(bytes.is_empty());
    cells
}

fn dictionary(file: &[u8], about: &Value) -> Vec<String> {
    let mut page = &file[about[11].int() as usize..];
    let header = structure(&mut page);
    assert_eq!((header[&1].int(), header[&7][2].int()), (2, 0));
    let word = |_| {
        let length = u32::from_le_bytes(take(&mut page)) as usize;
        let (word, rest) = page.split_at(length);
        page = rest;
        String::from_utf8(word.to_vec()).unwrap()
    };
    (0..header[&7][1].int()).map(word).collect()
}

/// A value of Thrift.
#[derive(Debug)]
enum Value {
    Int(i64),
    Text(String),
    List(Vec<Value>),
    Structure(BTreeMap<i64, Value>),
}

impl Value {
    fn int(&self) -> i64 {
        match self {
            Value::Int(value) => *value,
            other => panic!("{other:?}"),
        }
    }

    fn text(&self) -> String {
        match self {
            Value::Text(value) => value.clone(),
            other => panic!("{other:?}"),
        }
    }

    fn list(&self) -> &[Value] {
        match self {
            Value::List(values) => values,
            other => panic!("{other:?}"),
        }
    }
}

impl std::ops::Index<i64> for Value {
    type Output = Value;

    fn index(&self, id: i64) -> &Value {
        match self {
            Value::Structure(fields) => &fields[&id],
            other => panic!("{other:?}"),
        }
    }
}

fn take<const N: usize>(bytes: &mut &[u8]) -> [u8; N] {
    let (taken, rest) = bytes.split_first_chunk().unwrap();
    *bytes = rest;
    *taken
}

fn varint(bytes: &mut &[u8]) -> u64 {
    let mut value = 0;
    for shift in (0..).step_by(7) {
        let [byte] = take(bytes);
        value |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            break;
        }
    }
    value
}

fn structure(bytes: &mut &[u8]) -> BTreeMap<i64, Value> {
    let mut fields = BTreeMap::new();
    let mut id = 0;
    loop {
        let [key] = take(bytes);
        if key == 0 {
            return fields;
        }
        assert!(key >> 4 > 0, "the long form of a key");
        id += i64::from(key >> 4);
        fields.insert(id, value(bytes, key & 15));
    }
}

fn value(bytes: &mut &[u8], kind: u8) -> Value {
    match kind {
        1 | 2 => Value::Int(i64::from(kind == 1)),
        3 => Value::Int(i64::from(take::<1>(bytes)[0])),
        4..=6 => {
            let zigzag = varint(bytes);
            Value::Int((zigzag >> 1) as i64 ^ -((zigzag & 1) as i64))
        }
        8 => {
            let length = varint(bytes) as usize;
            let (text, rest) = bytes.split_at(length);
            *bytes = rest;
            Value::Text(String::from_utf8(text.to_vec()).unwrap())
        }
        9 => {
            let [head] = take(bytes);
            let length = match head >> 4 {
                15 => varint(bytes),
                length => u64::from(length),
            };
            Value::List((0..length).map(|_| value(bytes, head & 15)).collect())
        }
        12 => Value::Structure(structure(bytes)),
        kind => panic!("a type of Thrift that Parquet does not use here: {kind}"),
    }
}
