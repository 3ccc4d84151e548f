//! STL: triangles one by one, as text or as bytes.

use super::Triangles;

/// Bytes before the number of triangles, and of each triangle: a normal, three corners, two bytes for nothing.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// The triangles of a file.
pub fn read(bytes: &[u8]) -> Result<Triangles, String> {
    // a file of bytes may begin with the word of a text: its length says what it is
    if let Some(count) = bytes.get(HEADER..HEADER + 4) {
        let count = u32::from_le_bytes([count[0], count[1], count[2], count[3]]) as usize;
        let body = &bytes[HEADER + 4..];
        if count.checked_mul(TRIANGLE) == Some(body.len()) {
            let each = body.chunks_exact(TRIANGLE).map(|triangle| {
                std::array::from_fn(|corner| {
                    std::array::from_fn(|axis| {
                        let at = 12 + 12 * corner + 4 * axis;
                        f32::from_le_bytes(std::array::from_fn(|i| triangle[at + i]))
                    })
                })
            });
            return Ok(Triangles::welded(each));
        }
    }
    let text = String::from_utf8_lossy(bytes);
    if !text.trim_start().starts_with("solid") {
        return Err("its length is not that of its number of triangles".into());
    }
    let mut places: Vec<[f32; 3]> = Vec::new();
    let mut words = text.split_ascii_whitespace();
    while words.by_ref().any(|word| word == "vertex") {
        let mut number = || words.next().and_then(|word| word.parse().ok());
        match (number(), number(), number()) {
            (Some(x), Some(y), Some(z)) => places.push([x, y, z]),
            _ => return Err(format!("corner {} has no three numbers", places.len() + 1)),
        }
    }
    if places.is_empty() {
        return Err(
            "its length is not that of its number of triangles, and it is no text with corners"
                .into(),
        );
    }
    if !places.len().is_multiple_of(3) {
        return Err("a triangle has no three corners".into());
    }
    let each = places
        .chunks_exact(3)
        .map(|three| [three[0], three[1], three[2]]);
    Ok(Triangles::welded(each))
}
