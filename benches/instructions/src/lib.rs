//! The derivative of dummy15 for AArch64 as two symbols: `by_rustc`, which rustc compiled, and `by_engine`, which the
//! engine's machine code is. `count` disassembles both and counts instructions.

bryant_runtime::include_model!("dummy15");

/// The state and its derivative.
type State = <Mechanism<f64> as Model<f64>>::State;

/// The derivative over one state.
#[unsafe(no_mangle)]
pub fn by_rustc(model: &Mechanism<f64>, t: f64, y: &State, rate: &mut State) {
    model.each_rate(t, y, rate);
}

/// The number of bytes of the machine code, with its constants.
const BYTES: usize = include_bytes!(concat!(env!("OUT_DIR"), "/derivative.bin")).len();

/// The same as machine code, which is not called here.
#[unsafe(no_mangle)]
#[unsafe(link_section = ".text.by_engine")]
pub static by_engine: [u8; BYTES] = *include_bytes!(concat!(env!("OUT_DIR"), "/derivative.bin"));
