use bryant_study::summary::chaos::Basis;
use bryant_study::summary::family::HIGHEST;

#[test]
fn terms_are_counted_by_binomials() {
    // there are C(d + p, p) terms up to degree p
    let basis = Basis::new(&[HIGHEST; 3], 60).unwrap();
    assert_eq!(basis.ends, [1, 4, 10, 20, 35, 56]);
    let mut terms = basis.terms.clone();
    terms.sort();
    terms.dedup();
    assert_eq!(terms.len(), 56);
    assert!(Basis::new(&[HIGHEST; 60], 60).is_none());
}

#[test]
fn no_parameter_has_more_terms_than_functions() {
    // 3, 1 and 2 levels: (1, a, a²) × (1, c)
    let mut basis = Basis::new(&[2, 0, 1], 300).unwrap();
    assert_eq!(basis.ends, [1, 3, 5, 6]);
    assert!(
        basis
            .terms
            .iter()
            .all(|t| t[0] <= 2 && t[1] == 0 && t[2] <= 1)
    );
    basis.remove(&[1, 4]);
    assert_eq!(basis.ends, [1, 2, 3, 4]);
    assert!(Basis::new(&[0, 0], 300).is_none());
}
