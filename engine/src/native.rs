//! Machine code for this processor.

mod code;
#[cfg_attr(
    all(target_os = "macos", target_arch = "aarch64"),
    path = "native/apple_memory.rs"
)]
mod memory;

pub use code::{Call, Compiled};

#[cfg(target_arch = "aarch64")]
use bryant_generator::target::aarch64 as processor;
#[cfg(target_arch = "x86_64")]
use bryant_generator::target::x86_64 as processor;

use bryant_generator::expression::Function;
use bryant_generator::program::{Curve, List};
use bryant_generator::target::machine::Precision;
use bryant_runtime::{Layout, Real};
use processor::Target;

fn precision(layout: &Layout) -> Precision {
    match layout.single {
        true => Precision::Single,
        false => Precision::Double,
    }
}

/// The target of machine code over this scalar. `None` if the scalar is not made of numbers side by side, or if the
/// processor lacks the instructions.
#[cfg(target_arch = "x86_64")]
pub fn target<T: Real>() -> Option<Target> {
    use bryant_generator::target::machine::Length;
    let layout = Layout::of::<T>()?;
    let precision = precision(&layout);
    let length = match layout.lanes * precision.bytes() as usize {
        16 => Length::Sixteen,
        32 => Length::ThirtyTwo,
        64 => Length::SixtyFour,
        _ if layout.lanes == 1 => Length::Scalar,
        _ => return None,
    };
    let wide = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq");
    let there = match length {
        Length::SixtyFour => wide,
        Length::ThirtyTwo => is_x86_feature_detected!("avx2"),
        _ => is_x86_feature_detected!("avx"),
    };
    let fuses = !layout.fused || is_x86_feature_detected!("fma");
    (there && fuses).then_some(Target {
        length,
        precision,
        fused: layout.fused,
        many_registers: wide && is_x86_feature_detected!("avx512vl"),
        slopes: layout.slopes,
    })
}

/// The target of machine code over this scalar. `None` if the scalar is neither a number nor a register of 16 bytes.
#[cfg(target_arch = "aarch64")]
pub fn target<T: Real>() -> Option<Target> {
    let layout = Layout::of::<T>()?;
    let precision = precision(&layout);
    let lanes = match layout.lanes * precision.bytes() as usize {
        16 => true,
        _ if layout.lanes == 1 => false,
        _ => return None,
    };
    Some(Target {
        lanes,
        precision,
        fused: layout.fused,
        slopes: layout.slopes,
    })
}

/// True if there is machine code over this scalar.
pub fn has_machine_code<T: Real>() -> bool {
    target::<T>().is_some()
}

/// The machine code of a list over a scalar. `None` if there is none, so that the list must be interpreted. `curves`
/// are those of the model. `function` gives the functions that the list calls, except sine, cosine and `atan2`, which
/// are those of the scalar.
pub fn compile<T: Real, C: Call<T>>(
    list: &List,
    curves: &[Curve],
    function: impl FnMut(Function) -> C,
) -> Option<Compiled<T, C>> {
    Compiled::new(list, curves, &target::<T>()?, function)
}
