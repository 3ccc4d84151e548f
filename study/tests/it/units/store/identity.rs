use bryant_study::store::identity::block;

#[test]
fn blocks_are_many_but_not_small() {
    assert_eq!([1, 1000, 4096].map(block), [16; 3]);
    assert_eq!(block(100_000), 512);
    assert_eq!([1_000_000, 1_000_000_000].map(block), [4096; 2]);
}
