use bryant_generator::expression::passes::flatten::{Element, Signed};
use bryant_generator::expression::passes::pairs::{Pair, extract_pairs};

fn plus(elements: &[Element]) -> Signed {
    elements.iter().map(|&e| (false, e)).collect()
}

#[test]
fn the_most_frequent_pair_goes_first() {
    let mut lists = [
        plus(&[1, 2, 3]),
        plus(&[1, 2, 4]),
        plus(&[2, 3, 5]),
        plus(&[2, 3]),
    ];
    let pairs = extract_pairs(&mut lists, 10);
    let expected = Pair {
        first: 2,
        second: 3,
        opposite: false,
    };
    assert_eq!(pairs, [expected]);
    assert_eq!(
        lists,
        [
            plus(&[1, 10]),
            plus(&[1, 2, 4]),
            plus(&[5, 10]),
            plus(&[10])
        ]
    );
}

#[test]
fn pairs_are_equal_up_to_sign() {
    let mut lists = [
        vec![(false, 1), (true, 2), (false, 3)],
        vec![(true, 1), (false, 2), (false, 4)],
        vec![(false, 1), (false, 2), (false, 5)],
    ];
    let pairs = extract_pairs(&mut lists, 10);
    assert_eq!(pairs.len(), 1);
    assert!(pairs[0].opposite);
    assert_eq!(lists[0], [(false, 3), (false, 10)]);
    assert_eq!(lists[1], [(false, 4), (true, 10)]);
    assert_eq!(lists[2].len(), 3);
}

#[test]
fn pairs_of_pairs() {
    let mut lists = [plus(&[1, 2, 3, 4]), plus(&[1, 2, 3, 5]), plus(&[1, 2, 3])];
    let pairs = extract_pairs(&mut lists, 10);
    assert_eq!(pairs.len(), 2);
    assert_eq!(lists, [plus(&[4, 11]), plus(&[5, 11]), plus(&[11])]);
}

#[test]
fn squares_are_pairs() {
    let mut lists = [plus(&[1, 1, 2]), plus(&[1, 1, 3]), plus(&[1, 3])];
    let pairs = extract_pairs(&mut lists, 10);
    assert!(pairs.contains(&Pair {
        first: 1,
        second: 1,
        opposite: false
    }));
    let operations = |lists: &[Signed]| lists.iter().map(|l| l.len() - 1).sum::<usize>();
    assert_eq!(operations(&lists) + pairs.len(), 4);
}
