//! Writes pixels as PNG by <https://www.w3.org/TR/png-3/>: 8 bits each of red, green and blue, one compressed block.

use miniz_oxide::deflate::compress_to_vec_zlib;

/// The first bytes of every PNG.
const SIGNATURE: [u8; 8] = *b"\x89PNG\r\n\x1a\n";
/// The keyword and the text that name the program.
const SOFTWARE: &[u8] = b"Software\0bryant";
/// Level of compression from 0 to 10; higher levels take long and save little.
const COMPRESSION: u8 = 7;

/// The bytes of a PNG file. `points` has red, green, blue of each pixel, row after row.
pub fn encode([width, height]: [usize; 2], points: &[u8]) -> Vec<u8> {
    let mut header = Vec::new();
    for length in [width, height] {
        // the canvas is never wider or higher than 32 bits can hold
        header.extend((length as u32).to_be_bytes());
    }
    // bits per channel, red-green-blue, the only compression and filter, no interlacing
    header.extend([8, 2, 0, 0, 0]);
    let mut rows = Vec::with_capacity(points.len() + height);
    for row in points.chunks_exact(3 * width) {
        // filter 0: rows are stored as they are, not as differences from neighbours, which compresses pictures of lines
        // best
        rows.push(0);
        rows.extend(row);
    }
    let mut file = SIGNATURE.to_vec();
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"tEXt", SOFTWARE);
    chunk(
        &mut file,
        b"IDAT",
        &compress_to_vec_zlib(&rows, COMPRESSION),
    );
    chunk(&mut file, b"IEND", &[]);
    file
}

/// True if these are the first bytes of a file that [`encode`] made.
pub fn is_own(bytes: &[u8]) -> bool {
    let mut text = Vec::new();
    chunk(&mut text, b"tEXt", SOFTWARE);
    // after the signature (8 bytes) and the header (25 bytes)
    bytes.starts_with(&SIGNATURE) && bytes.get(33..).is_some_and(|rest| rest.starts_with(&text))
}

fn chunk(file: &mut Vec<u8>, kind: &[u8; 4], data: &[u8]) {
    file.extend((data.len() as u32).to_be_bytes());
    let start = file.len();
    file.extend(kind);
    file.extend(data);
    let sum = checksum(&file[start..]);
    file.extend(sum.to_be_bytes());
}

/// CRC-32 of ISO 3309.
fn checksum(bytes: &[u8]) -> u32 {
    let mut sum = u32::MAX;
    for byte in bytes {
        sum ^= u32::from(*byte);
        for _ in 0..8 {
            let odd = sum & 1 == 1;
            sum >>= 1;
            if odd {
                sum ^= 0xedb8_8320;
            }
        }
    }
    !sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checksums_are_those_of_the_standard() {
        // the check value of CRC-32, and the end of every PNG
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
        assert_eq!(checksum(b"IEND"), 0xae42_6082);
    }
}
