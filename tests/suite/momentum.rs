//! The balance of momentum, ṗ = Σ F and L̇ = Σ (r × F + M), as an identity of the equations at any state of every
//! model.
//!
//! The rates are derived from the momenta and the accelerations, the external wrench from the forces only. So the test
//! finds a force without a reaction, at a wrong point, or with a moment of its own. See [`crate::identity`] for the
//! accuracy.

use crate::identity::Balance;
use bryant_generator::expression::NodeId;
use bryant_generator::method::Method;
use bryant_generator::model::Reference;
use bryant_tests::models::MODELS;

#[test]
fn the_thrust_is_the_rate_of_the_momentum() {
    let mut free = 0;
    for compiled in MODELS {
        let model = compiled.model();
        let balance = Balance::of(&model);
        let systems = &model.systems;
        let any = systems
            .iter()
            .any(|s| matches!(s.reference, Reference::Free));
        assert_eq!(compiled.entry.info.free, any, "{}", model.name);
        let of = |method| -> Vec<NodeId> {
            let values = balance.equations.section(method).iter();
            values.map(|named| named.value).collect()
        };
        let momentum = of(Method::Momentum);
        assert_eq!(momentum.len(), if any { 6 } else { 0 });
        if any {
            let names = ["p_x", "p_y", "p_z", "L_x", "L_y", "L_z"];
            balance.holds(&names, &momentum, &of(Method::ExternalWrench));
            free += 1;
        }
    }
    assert!(free > 10, "only {free} models move freely");
}
