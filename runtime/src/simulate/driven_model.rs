//! A model whose inputs change from outside during a run: by a controller, or by another program.

use crate::failure::Refusal;
use crate::{Adjustable, Dynamics, Info, Real, Section};
use core::cell::{Cell, RefCell};

/// A model whose [inputs](crate::ParameterInfo::input) may be set between two advances of a [`Run`](super::Run). It is
/// shared by the run, which reads it, and the controller, which sets inputs.
pub struct Driven<'m, T: Real> {
    model: RefCell<&'m mut dyn Adjustable<T>>,
    /// All parameters, then the inputs before the last change.
    memory: RefCell<&'m mut [T]>,
    info: &'m Info<'m>,
    /// True if an input has changed since the run last looked.
    changed: Cell<bool>,
}

impl<'m, T: Real> Driven<'m, T> {
    /// Number of scalars that [`Driven::new`] needs: one for each parameter, and one more for each input.
    pub fn length(info: &Info) -> usize {
        info.parameters.len() + info.inputs().count()
    }

    /// A model at its present parameters, and its facts, which must live apart from it because its inputs change: those
    /// of its family or [`Model::INFO`](crate::Model::INFO). `memory` has [`Driven::length`] scalars of any value.
    ///
    /// # Panics
    /// With memory of another length, or with facts of another model.
    pub fn new(model: &'m mut dyn Adjustable<T>, info: &'m Info<'m>, memory: &'m mut [T]) -> Self {
        assert!(model.info() == info, "the model is not {}", info.name);
        assert_eq!(
            memory.len(),
            Self::length(info),
            "memory for the parameters of {}",
            info.name
        );
        for (index, place) in memory.iter_mut().enumerate() {
            if let Some(value) = model.parameter(index) {
                *place = value;
            }
        }
        Driven {
            model: RefCell::new(model),
            memory: RefCell::new(memory),
            info,
            changed: Cell::new(false),
        }
    }

    /// Sets all inputs, in the order of [`Info::inputs`] \[SI\].
    ///
    /// # Errors
    /// A value that is not finite or outside of the limits of its input, or values that break a condition of the model;
    /// nothing is set then.
    ///
    /// # Panics
    /// With another number of values than there are inputs.
    pub fn set_inputs(&self, values: &[T]) -> Result<(), Refusal> {
        let count = self.info.inputs().count();
        assert_eq!(values.len(), count, "inputs of {}", self.info.name);
        for (index, value) in self.info.inputs().zip(values) {
            let of = &self.info.parameters[index];
            let value = value.to_f64();
            if !value.is_finite() {
                return Err(Refusal::NotFinite(index, value));
            }
            if !(of.min..=of.max).contains(&value) {
                return Err(Refusal::OutOfLimits(index, value));
            }
        }
        let memory = &mut **self.memory.borrow_mut();
        let (parameters, held) = memory.split_at_mut(self.info.parameters.len());
        let mut inputs = self.info.inputs().zip(values);
        if inputs.all(|(index, value)| parameters[index] == *value) {
            return Ok(());
        }
        let mut model = self.model.borrow_mut();
        for ((index, value), held) in self.info.inputs().zip(values).zip(&mut *held) {
            *held = core::mem::replace(&mut parameters[index], *value);
        }
        model.set_parameters(parameters);
        if let Some(condition) = model.violated() {
            for (index, held) in self.info.inputs().zip(held) {
                parameters[index] = *held;
            }
            model.set_parameters(parameters);
            return Err(Refusal::Condition(condition));
        }
        self.changed.set(true);
        Ok(())
    }

    /// True if an input has changed since the last call.
    pub(super) fn take_change(&self) -> bool {
        self.changed.take()
    }
}

impl<T: Real> Dynamics<T> for Driven<'_, T> {
    fn info(&self) -> &Info<'_> {
        self.info
    }

    fn parameter(&self, index: usize) -> Option<T> {
        self.model.borrow().parameter(index)
    }

    fn initial_state(&self, y: &mut [T]) {
        self.model.borrow().initial_state(y);
    }

    fn derivative(&self, t: T, y: &[T], rate: &mut [T]) {
        self.model.borrow().derivative(t, y, rate);
    }

    fn coordinate_rates(&self, y: &[T], rate: &mut [T]) {
        self.model.borrow().coordinate_rates(y, rate);
    }

    fn jacobian(&self, t: T, y: &[T], by_state: &mut [T], by_time: &mut [T]) -> bool {
        self.model.borrow().jacobian(t, y, by_state, by_time)
    }

    fn normalize(&self, y: &mut [T]) {
        self.model.borrow().normalize(y);
    }

    fn smallest_pivot(&self, t: T, y: &[T]) -> Option<(usize, T)> {
        self.model.borrow().smallest_pivot(t, y)
    }

    fn violated(&self) -> Option<usize> {
        self.model.borrow().violated()
    }

    fn kink_after(&self, t: f64) -> T {
        self.model.borrow().kink_after(t)
    }

    fn section(&self, section: Section, t: T, y: &[T], results: &mut [T]) {
        self.model.borrow().section(section, t, y, results);
    }

    fn sections(&self, t: T, y: &[T], wanted: &mut [(Section, &mut [T])]) {
        self.model.borrow().sections(t, y, wanted);
    }
}
