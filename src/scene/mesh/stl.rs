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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_bytes_say_the_same() {
        let corners = [
            [0.0f32, 0.0, 0.0],
            [2.0, 0.0, 0.0],
            [0.0, 3.0, 1.0],
            [0.0, 0.0, 4.0],
        ];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut text = "solid a part\n".to_owned();
        // as some programs begin files of bytes
        let mut bytes = b"solid".to_vec();
        bytes.resize(80, b' ');
        bytes.extend(4u32.to_le_bytes());
        for face in faces {
            text += "facet normal 0 0 1\n outer loop\n";
            bytes.extend([0; 12]);
            for [x, y, z] in face.map(|corner: usize| corners[corner]) {
                text += &format!("  vertex {x:e} {y} {z}\n");
                bytes.extend([x, y, z].iter().flat_map(|x| x.to_le_bytes()));
            }
            text += " endloop\nendfacet\n";
            bytes.extend([0; 2]);
        }
        text += "endsolid\n";
        let (a, b) = (read(text.as_bytes()).unwrap(), read(&bytes).unwrap());
        assert_eq!(a, b);
        assert_eq!((a.places.len(), a.corners.len()), (4, 4));
        // a tetrahedron: (2 × 3 × 4) / 6
        assert!((super::super::volume(&a) - 4.0).abs() < 1e-12);
        bytes.pop();
        assert!(read(&bytes).is_err());
        assert!(read(b"solid vertex 1 2").is_err());
        assert!(read(b"").is_err());
    }
}
