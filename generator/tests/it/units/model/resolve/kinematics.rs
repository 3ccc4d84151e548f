use bryant_generator::model::resolve::kinematics::rotation;
use bryant_generator::rotation::apply;

#[test]
fn the_plane_turns_x_towards_minus_z() {
    let turned = apply(&rotation([0.0, 0.3, 0.0]), [1.0, 0.0, 0.0]);
    assert_eq!(turned, [0.3f64.cos(), 0.0, -0.3f64.sin()]);
}
