use bryant_generator::human::size::normal;
use bryant_generator::human::{Person, Sex, Size, body};

#[test]
fn percentiles_meet_the_table_and_grow() {
    // tables of the normal distribution
    for (p, z) in [
        (0.5, 0.0),
        (0.95, 1.644_853_627),
        (0.01, -2.326_347_874),
        (0.99, 2.326_347_874),
    ] {
        assert!((normal(p) - z).abs() < 1e-8, "{p}");
    }
    for sex in [Sex::Male, Sex::Female] {
        let all: Vec<Size> = (1..=99)
            .map(|p| Size::percentile(sex, f64::from(p)).unwrap())
            .collect();
        assert!(
            all.windows(2)
                .all(|two| two[0].stature <= two[1].stature && two[0].mass <= two[1].mass)
        );
        assert!(all.iter().all(|size| body(&Person::Size(*size)).is_ok()));
    }
    let man = Size::percentile(Sex::Male, 95.0).unwrap();
    assert_eq!((man.stature, man.mass), (1.870, 110.7));
    assert_eq!(Size::percentile(Sex::Male, 0.5), None);
    assert_eq!(Size::percentile(Sex::Male, f64::NAN), None);
}

#[test]
fn a_name_is_a_size_or_a_dummy() {
    let man = Person::Size(Size::like("male-50").unwrap());
    assert_eq!(Person::named("male-50"), Some(man));
    assert_eq!(Person::named("child-3"), Some(Person::Dummy("child-3")));
    assert_eq!(Person::named("male-51"), None);
}
