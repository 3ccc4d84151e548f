//! Compiled equations behind function pointers, with the YAML that they were generated from.

use bryant_generator::model::Model;
use bryant_generator::read;
use bryant_runtime::ParameterSet;
use bryant_runtime::program::Entry;
use std::path::Path;

/// A compiled model.
#[derive(Clone, Copy)]
pub struct Compiled {
    /// Path of its YAML, relative to this crate.
    pub path: &'static str,
    /// The model.
    pub entry: Entry,
    /// The matrices of its module, if it was compiled with them.
    pub matrices: Option<Matrices>,
}

/// S by rows, r_s, r_k and v̇, one after the other, for parameters, t, q, v, m.
pub type Matrices = fn(&[f64], f64, &[f64], &[f64], &[f64]) -> Vec<f64>;

impl Compiled {
    /// The model that its YAML describes.
    ///
    /// # Panics
    /// If it is not a valid model.
    pub fn model(&self) -> Model {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(self.path);
        read(&path)
            .unwrap_or_else(|problems| panic!("{problems}"))
            .0
    }
}

/// Parameters of a module, in the model's order.
///
/// # Panics
/// If there are more than the model has.
pub fn parameters<P: ParameterSet<f64>>(values: &[f64]) -> P {
    let mut parameters = P::defaults();
    for (index, value) in values.iter().enumerate() {
        assert!(parameters.set(index, *value), "parameter {index}");
    }
    parameters
}

/// The [`Compiled`] of a generated module without Jacobian, from the path of its YAML and the path of the module. `; m`
/// behind them says that its methods take a memory, `, in t` that S and r_s depend on time.
#[macro_export]
macro_rules! compiled {
    ($path:expr, $($module:ident)::+ $(, in $t:ident)? $(; $m:ident)?) => {
        $crate::compiled_equations::Compiled {
            path: $path,
            entry: bryant_runtime::program::Entry::without_jacobian::<$($module)::+::Mechanism<f64>>(),
            matrices: Some(|parameters, t, q, v, _memory| {
                let mechanism =
                    $($module)::+::Mechanism::<f64>::new($crate::compiled_equations::parameters(parameters));
                let q = q.try_into().expect("as many coordinates as the model has");
                let v = v.try_into().expect("as many velocities as the model has");
                $(let $t = t;)?
                $(let $m = _memory.try_into().expect("as much memory as the model has");)?
                // nalgebra stores by columns
                let matrix = mechanism.mass_matrix($($t,)? q $(, $m)?).transpose();
                let mut values = matrix.as_slice().to_vec();
                values.extend(mechanism.velocity_forces($($t,)? q, v $(, $m)?).as_slice());
                values.extend(mechanism.applied_forces(t, q, v $(, $m)?).as_slice());
                values.extend(mechanism.accelerations(t, q, v $(, $m)?));
                values
            }),
        }
    };
}
