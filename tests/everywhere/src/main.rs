//! `everywhere MODEL.yaml...` runs each model by the engine. It prints the number of steps and a digest of all times,
//! states and outputs.

use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::{Dynamics, Settings, simulate};
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

/// The hash of Fowler, Noll and Vo, of 64 bits.
fn add(hash: u64, number: f64) -> u64 {
    // NaN has many patterns of bits
    let bits = if number.is_nan() {
        u64::MAX
    } else {
        number.to_bits()
    };
    let step = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bits.to_le_bytes().into_iter().fold(hash, step)
}

fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path)?;
        let included = |file: &Path| std::fs::read_to_string(file);
        let (model, _) = bryant_generator::read_str(&path, &text, &included)?;
        let engine = Engine::new(Config::new().lists(&model))?;
        let machine = engine.over::<f64>();
        let mut start = vec![0.0; machine.info().state_length()];
        machine.initial_state(&mut start);
        let mut hash = 0xcbf2_9ce4_8422_2325;
        let settings = Settings::of(engine.info());
        let report = simulate::run(&machine, &start, &settings, None, &mut |sample| {
            let numbers = [&[sample.t], sample.state, sample.outputs].concat();
            hash = numbers.into_iter().fold(hash, add);
            ControlFlow::Continue(())
        })
        .map_err(|failure| format!("{path}: {failure:?}"))?;
        println!("{hash:016x} {:6} steps {path}", report.steps);
    }
    Ok(())
}
