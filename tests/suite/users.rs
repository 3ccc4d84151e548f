//! The functions of a model, including user functions, compiled for the interpreted graph.

use bryant_generator::expression::Function;
use bryant_generator::model::Model;
use bryant_tests::models::{elbow_hold, user_joints, user_plane, user_space};

/// The functions of a model at plain numbers.
///
/// # Panics
/// If the model has a user function that is not listed here.
pub fn functions(model: &Model) -> impl Fn(Function, &[f64]) -> f64 + '_ {
    let known = bryant::evaluation::functions(model);
    move |function, arguments| match function {
        Function::User(call) => {
            let force = &model.forces[usize::from(call.force)].name;
            results(&model.name, force, arguments)[usize::from(call.part)]
        }
        function => known(function, arguments),
    }
}

fn results(model: &str, force: &str, arguments: &[f64]) -> Vec<f64> {
    macro_rules! call {
        ($($path:ident)::+) => {
            $($path)::+(arguments.try_into().expect("as many as the function takes")).to_vec()
        };
    }
    match (model, force) {
        ("skydiver", _) => call!(bryant_generated::skydiver::drag::scalars),
        ("elbow", _) => call!(bryant_generated::elbow::muscle::scalars),
        ("elbow-hold", _) => call!(elbow_hold::muscle::scalars),
        ("user-joints", _) => call!(user_joints::rig::scalars),
        ("user-plane", _) => call!(user_plane::plane::scalars),
        ("user-space", "neck") => call!(user_space::neck::scalars),
        ("user-space", "belt") => call!(user_space::belt::scalars),
        ("user-space", "push") => call!(user_space::push::scalars),
        ("user-space", _) => call!(user_space::along::scalars),
        _ => panic!("the function of {force} in {model} is to be listed here"),
    }
}
