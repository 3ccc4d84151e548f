//! The part of Thrift's compact protocol
//! (<https://github.com/apache/thrift/blob/master/doc/specs/thrift-compact-protocol.md>) that the metadata of Parquet
//! need.

/// Fields of a structure, by increasing ids.
#[derive(Default)]
pub struct Fields {
    bytes: Vec<u8>,
    last: u8,
}

/// An element of a list.
pub trait Element {
    /// The number of its type.
    const KIND: u8;
    /// Its bytes.
    fn write(&self, bytes: &mut Vec<u8>);
}

impl Fields {
    /// Adds an integer of 32 bits.
    pub fn int(self, id: u8, value: i32) -> Self {
        self.element(id, &value)
    }

    /// Adds an integer of 64 bits.
    pub fn long(self, id: u8, value: i64) -> Self {
        self.element(id, &value)
    }

    /// Adds a text.
    pub fn text(self, id: u8, value: &str) -> Self {
        self.element(id, &value)
    }

    /// Adds a structure.
    pub fn fields(self, id: u8, value: Fields) -> Self {
        self.element(id, &value)
    }

    /// Adds an integer of 8 bits.
    pub fn byte(mut self, id: u8, value: u8) -> Self {
        self.key(id, 3);
        self.bytes.push(value);
        self
    }

    /// Adds the value false.
    pub fn no(mut self, id: u8) -> Self {
        self.key(id, 2);
        self
    }

    /// Adds a list of elements of one type.
    pub fn list<T: Element>(mut self, id: u8, elements: &[T]) -> Self {
        self.key(id, 9);
        match elements.len() {
            length @ 0..15 => self.bytes.push((length as u8) << 4 | T::KIND),
            length => {
                self.bytes.push(0xf0 | T::KIND);
                varint(&mut self.bytes, length as u64);
            }
        }
        for element in elements {
            element.write(&mut self.bytes);
        }
        self
    }

    /// The bytes of the structure.
    pub fn finish(self) -> Vec<u8> {
        let mut bytes = self.bytes;
        bytes.push(0);
        bytes
    }

    fn element<T: Element>(mut self, id: u8, value: &T) -> Self {
        self.key(id, T::KIND);
        value.write(&mut self.bytes);
        self
    }

    /// Writes the difference to the last id, which is at most 15 here, and the type.
    fn key(&mut self, id: u8, kind: u8) {
        self.bytes.push((id - self.last) << 4 | kind);
        self.last = id;
    }
}

impl Element for i32 {
    const KIND: u8 = 5;

    fn write(&self, bytes: &mut Vec<u8>) {
        signed(bytes, i64::from(*self));
    }
}

impl Element for i64 {
    const KIND: u8 = 6;

    fn write(&self, bytes: &mut Vec<u8>) {
        signed(bytes, *self);
    }
}

impl Element for &str {
    const KIND: u8 = 8;

    fn write(&self, bytes: &mut Vec<u8>) {
        varint(bytes, self.len() as u64);
        bytes.extend(self.as_bytes());
    }
}

impl Element for Fields {
    const KIND: u8 = 12;

    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend(&self.bytes);
        bytes.push(0);
    }
}

/// Writes an integer with its sign in the lowest bit.
fn signed(bytes: &mut Vec<u8>, value: i64) {
    varint(bytes, ((value << 1) ^ (value >> 63)).cast_unsigned());
}

/// Writes seven bits in each byte, the lowest first.
pub fn varint(bytes: &mut Vec<u8>, mut value: u64) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}
