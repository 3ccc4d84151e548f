//! OBJ of Wavefront: places and the faces between them, as text. Materials, normals and textures are not used.

use super::Triangles;

/// The triangles of a file; a face of more corners becomes a fan.
pub fn read(bytes: &[u8]) -> Result<Triangles, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut triangles = Triangles::default();
    for (index, line) in text.lines().enumerate() {
        let wrong = |what: &str| format!("line {}: {what}", index + 1);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let mut number = || words.next().and_then(|word| word.parse().ok());
                let (Some(x), Some(y), Some(z)) = (number(), number(), number()) else {
                    return Err(wrong("a place has three numbers"));
                };
                triangles.places.push([x, y, z]);
            }
            Some("f") => {
                let count = triangles.places.len() as i64;
                // place/texture/normal, from 1, or from the end below 0
                let corner = |word: &str| {
                    let number: i64 = word.split('/').next()?.parse().ok()?;
                    let index = if number < 0 {
                        count + number
                    } else {
                        number - 1
                    };
                    (0..count).contains(&index).then_some(index as u32)
                };
                let corners: Option<Vec<u32>> = words.map(corner).collect();
                let corners =
                    corners.ok_or_else(|| wrong("a corner of this face does not exist"))?;
                for two in corners.get(1..).unwrap_or_default().windows(2) {
                    triangles.corners.push([corners[0], two[0], two[1]]);
                }
            }
            _ => {}
        }
    }
    Ok(triangles)
}
