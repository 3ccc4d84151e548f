use bryant_study::shard::Shard;

#[test]
fn shards_share_all_blocks_out() {
    for n in 1..9 {
        let mut blocks: Vec<u64> = (0..n)
            .flat_map(|i| Shard::new(i, n).unwrap().blocks(23))
            .collect();
        blocks.sort_unstable();
        assert_eq!(blocks, (0..23).collect::<Vec<u64>>());
    }
}

#[test]
fn shards_are_read_from_text() {
    assert_eq!("2/3".parse(), Shard::new(2, 3));
    for wrong in ["3/3", "0/0", "1", "-1/3", "a/b", ""] {
        assert!(wrong.parse::<Shard>().is_err(), "{wrong}");
    }
}
