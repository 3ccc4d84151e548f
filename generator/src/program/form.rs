//! A number that tells whether two builds of the generator write [`Lists`](super::Lists) in the same form.

/// The files whose types are part of `Lists`, or of what these are made of: all from which `Lists` are read again.
pub const FILES: &[&str] = &[
    include_str!("lists.rs"),
    include_str!("list.rs"),
    include_str!("facts.rs"),
    include_str!("../equations.rs"),
    include_str!("../expression/node.rs"),
    include_str!("../method/mod.rs"),
    include_str!("../model/curve.rs"),
    include_str!("../description/rule.rs"),
    include_str!("../model/units.rs"),
];

/// A digest of the text of these files: lists that were written by a build with the same number can be read. Another
/// number may mean nothing but another comment.
pub const FORM: u64 = digest(FILES);

/// FNV-1a of 64 bits, without carriage returns, which some systems add.
const fn digest(texts: &[&str]) -> u64 {
    let (mut digest, mut text) = (0xcbf2_9ce4_8422_2325_u64, 0);
    while text < texts.len() {
        let (bytes, mut i) = (texts[text].as_bytes(), 0);
        while i < bytes.len() {
            if bytes[i] != b'\r' {
                digest = (digest ^ bytes[i] as u64).wrapping_mul(0x0100_0000_01b3);
            }
            i += 1;
        }
        text += 1;
    }
    digest
}
