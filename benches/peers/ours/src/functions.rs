//! The functions of a robot by the engine's machine code: one state after the other, or one in each lane of a register.

use crate::lanes::registers;
use crate::{Result, robots, time};
use bryant_engine::Engine;
use bryant_generator::Config;
use bryant_runtime::Several;
use bryant_runtime::real::lanes::OfAnyWidth;
use std::path::Path;

/// A function of a robot.
pub struct Of {
    engine: Engine,
}

impl Of {
    /// The function of a robot in a folder.
    pub fn new(folder: &Path, name: &str, function: &str) -> Result<Self> {
        let robot = robots::ROBOTS.iter().find(|(of, _)| *of == name);
        let (_, base) = *robot.ok_or_else(|| format!("there is no robot {name:?}"))?;
        let imported = robots::read(folder, name, base)?;
        let nothing = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let (model, _) = bryant_generator::read_str(name, &imported.yaml, &nothing)?;
        let mut config = Config::new();
        config.functions([function]);
        config.requests(&model, name)?;
        Ok(Of {
            engine: Engine::of(&model, &config)?,
        })
    }

    fn length(&self) -> usize {
        let function = &self.engine.functions()[0];
        function.rows.len() * function.columns.len()
    }

    /// Times of batches \[ns per state\], and the values at each state. A row is q, v, and accelerations.
    pub fn one_by_one(&self, rows: &[Vec<f64>]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let machine = self.engine.over::<f64>();
        let states = self.engine.info().state_length();
        let mut results = vec![vec![0.0; self.length()]; rows.len()];
        let times = time::batches(rows.len(), || {
            for (row, result) in rows.iter().zip(&mut results) {
                machine.function(0, 0.0, &row[..states], &row[states..], result);
            }
            std::hint::black_box(&mut results);
        });
        (times, results)
    }
}

/// The same for as many states at once as a register has lanes.
pub struct Abreast<'a>(pub &'a Of, pub &'a [Vec<f64>]);

impl OfAnyWidth for Abreast<'_> {
    type Output = (Vec<f64>, Vec<Vec<f64>>);

    fn run<T: Several<One = f64>>(self) -> Self::Output {
        let Abreast(of, rows) = self;
        let machine = of.engine.over::<T>();
        let states = of.engine.info().state_length();
        let registers: Vec<Vec<T>> = registers(rows, rows[0].len());
        let zero = T::from_f64(0.0);
        let mut results = vec![vec![zero; of.length()]; registers.len()];
        // the number of states in a batch includes the copies that fill the last register
        let times = time::batches(registers.len() * T::LANES, || {
            for (row, result) in registers.iter().zip(&mut results) {
                machine.function(0, zero, &row[..states], &row[states..], result);
            }
            std::hint::black_box(&mut results);
        });
        let row = |k: usize| {
            let values = results[k / T::LANES].iter();
            values.map(|value| value.lane(k % T::LANES)).collect()
        };
        (times, (0..rows.len()).map(row).collect())
    }
}
