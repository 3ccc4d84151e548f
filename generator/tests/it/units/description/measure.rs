use bryant_generator::description::measure::ALL;
use bryant_table::unit::{Dimension, product};

#[test]
fn the_text_of_a_unit_has_its_dimension() {
    for (unit, expected) in ALL {
        let spelled = unit.replace('·', "*").replace('²', "^2");
        let found = match spelled.as_str() {
            "" => Dimension::ONE,
            spelled => product(spelled).expect("a unit").dimension,
        };
        assert!(expected.accepts(found), "{unit}: {}", expected.name);
    }
}
