//! Runs, rows and gradients of a model by its engine. These functions are not generic, so that the time loops over all
//! scalars are compiled with this crate, and not with crates that use it.

use crate::model::Engine;
use bryant_runtime::batch::rows::{self, Gradients, NoSuchRegisters, Results, Sampled};
use bryant_runtime::program::{Job, Observer, Outcome, SampleWriter, run_job_observed};
use bryant_runtime::{Adjustable, DoubleDouble, Family};

impl Engine {
    /// The model over doubles, with the default values of all parameters.
    #[inline(never)]
    pub fn in_double(&self) -> Box<dyn Adjustable<f64> + '_> {
        Family::over(self)
    }

    /// The model over double-doubles, with the default values of all parameters.
    #[inline(never)]
    pub fn in_double_double(&self) -> Box<dyn Adjustable<DoubleDouble> + '_> {
        Family::over(self)
    }

    /// Runs a job: see [`run_job_observed`].
    #[inline(never)]
    pub fn run(
        &self,
        job: &Job,
        writer: &mut SampleWriter<'_>,
        observer: &mut Observer<'_>,
    ) -> Outcome {
        run_job_observed(self, job, writer, observer)
    }

    /// Runs rows of parameters \[SI\]: [`rows::rows`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn rows(&self, job: &rows::Job, rows: &[f64]) -> Result<Results, NoSuchRegisters> {
        rows::rows(self, job, rows)
    }

    /// Runs rows as [`Engine::rows`] does, and reports rows that take long: [`rows::rows_heard`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn rows_heard(
        &self,
        job: &rows::Job,
        rows: &[f64],
        hear: &dyn Fn(rows::Lingers),
    ) -> Result<Results, NoSuchRegisters> {
        rows::rows_heard(self, job, rows, hear)
    }

    /// Runs rows in single precision: [`rows::rows_of_singles`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn rows_of_singles(
        &self,
        job: &rows::Job,
        rows: &[f64],
    ) -> Result<Results, NoSuchRegisters> {
        rows::rows_of_singles(self, job, rows)
    }

    /// Runs rows in single precision, and reports rows that take long: [`rows::rows_of_singles_heard`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn rows_of_singles_heard(
        &self,
        job: &rows::Job,
        rows: &[f64],
        hear: &dyn Fn(rows::Lingers),
    ) -> Result<Results, NoSuchRegisters> {
        rows::rows_of_singles_heard(self, job, rows, hear)
    }

    /// Samples of outputs of one row \[SI\]: [`rows::series`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn series(&self, job: &rows::Job, row: &[f64], outputs: &[usize]) -> Sampled {
        rows::series(self, job, row, outputs)
    }

    /// Samples of outputs of one row in single precision: [`rows::series_of_singles`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn series_of_singles(&self, job: &rows::Job, row: &[f64], outputs: &[usize]) -> Sampled {
        rows::series_of_singles(self, job, row, outputs)
    }

    /// Responses of a row \[SI\] and their derivatives in several directions: [`rows::gradients`].
    ///
    /// # Errors
    /// If the processor lacks the registers that the job asks for.
    #[inline(never)]
    pub fn gradients(
        &self,
        job: &rows::Job,
        row: &[f64],
        directions: &[f64],
    ) -> Result<Gradients, NoSuchRegisters> {
        rows::gradients(self, job, row, directions)
    }
}
