use bryant::command::export::library::recognised;

#[test]
fn platforms_are_recognised_by_the_first_bytes() {
    let mut elf = vec![0; 64];
    elf[..4].copy_from_slice(b"\x7fELF");
    elf[18] = 183;
    assert_eq!(recognised(&elf).map(|of| of.name), Some("aarch64-linux"));
    let mut portable = vec![0; 256];
    portable[..2].copy_from_slice(b"MZ");
    portable[60] = 128;
    portable[132..134].copy_from_slice(&[0x64, 0x86]);
    assert_eq!(
        recognised(&portable).map(|of| of.name),
        Some("x86_64-windows")
    );
    portable.truncate(100);
    assert!(recognised(&portable).is_none());
    assert!(recognised(b"#!/bin/sh").is_none() && recognised(b"").is_none());
}
