use bryant_generator::target::c::support::PARTS;

#[test]
fn each_part_stands_behind_those_that_it_needs() {
    for (k, part) in PARTS.iter().enumerate() {
        for need in part.needs {
            assert!(
                PARTS[..k].iter().any(|before| before.name == *need),
                "{need}"
            );
        }
    }
}
