//! A run with everything that it refers to, as one value.

#![expect(
    unsafe_code,
    reason = "a run borrows its engine, its model, its inputs, its watch and its memory; here they live together"
)]

use bryant_engine::Engine;
use bryant_runtime::program::Finding;
use bryant_runtime::simulate::{Driven, Run, Sample, Watch, workspace_length};
use bryant_runtime::{Adjustable, ENERGY_LIMIT, Failure, Refusal, Settings};

/// A value with an address of its own, which others refer to until it is dropped.
struct Held<T: ?Sized>(*mut T);

impl<T: ?Sized> Held<T> {
    fn new(value: Box<T>) -> Self {
        Held(Box::into_raw(value))
    }

    /// # Safety
    /// There is no other reference, and this one is not used after `self` is dropped.
    unsafe fn get<'a>(&self) -> &'a mut T {
        // SAFETY: it was made by a box, and the caller keeps the rest
        unsafe { &mut *self.0 }
    }
}

impl<T: ?Sized> Drop for Held<T> {
    fn drop(&mut self) {
        // SAFETY: made by a box, dropped once
        drop(unsafe { Box::from_raw(self.0) });
    }
}

/// A run under way. Fields are dropped in their order, each before what it refers to.
pub struct Running {
    run: Option<Run<'static, 'static, f64>>,
    driven: Held<Driven<'static, f64>>,
    watch: Held<Watch<'static, f64>>,
    _model: Held<Box<dyn Adjustable<f64>>>,
    _parameters: Held<[f64]>,
    _memory: Held<[f64]>,
    _engine: Held<Engine>,
}

impl Running {
    /// A run of a model from a state, or from that of its parameters.
    ///
    /// # Errors
    /// As [`Run::new`], in words.
    pub fn new(
        engine: &Engine,
        parameters: &[f64],
        start: Option<&[f64]>,
        settings: &Settings,
    ) -> Result<Self, String> {
        let engine = Held::new(Box::new(engine.clone()));
        // SAFETY: there are only shared references to the engine, and the engine is dropped last
        let of: &'static Engine = unsafe { engine.get() };
        let info = of.info();
        let model: Box<dyn Adjustable<f64>> = of.in_double();
        let model = Held::new(Box::new(model));
        let memory = Held::new(vec![0.0; workspace_length(info, settings)].into_boxed_slice());
        let room = Held::new(vec![0.0; Driven::<f64>::length(info)].into_boxed_slice());
        let watch = Held::new(Box::new(Watch::new(info, ENERGY_LIMIT)));
        // SAFETY: each of the three is referred to here alone, and dropped after what is made of it
        let (inner, room_of, memory_of) = unsafe { (model.get(), room.get(), memory.get()) };
        inner.set_parameters(parameters);
        let mut state = vec![0.0; info.state_length()];
        match start {
            Some(start) => state.copy_from_slice(start),
            None => inner.initial_state(&mut state),
        }
        let driven = Held::new(Box::new(Driven::new(&mut **inner, info, room_of)));
        // SAFETY: the run has the watch until the run is dropped; the inputs are only shared from here on
        let (shared, watched) = unsafe { (&*driven.get(), watch.get()) };
        let run = match info.inputs().next() {
            None => Run::new(memory_of, shared, &state, settings, Some(watched)),
            Some(_) => Run::driven(memory_of, shared, &state, settings, Some(watched)),
        };
        Ok(Running {
            run: Some(run.map_err(|failure| failure.to_string())?),
            driven,
            watch,
            _model: model,
            _parameters: room,
            _memory: memory,
            _engine: engine,
        })
    }

    /// Advances to a time \[s\] and samples there: [`Run::advance_to`].
    ///
    /// # Errors
    /// As [`Run::advance_to`].
    pub fn advance_to(&mut self, t: f64) -> Result<Sample<'_, f64>, Failure<'_>> {
        match &mut self.run {
            Some(run) => run.advance_to(t),
            None => unreachable!("a run is ended once, with its value"),
        }
    }

    /// The model with its present inputs, and its inputs.
    pub fn driven(&self) -> &Driven<'static, f64> {
        // SAFETY: nothing ever has an exclusive reference to it
        unsafe { &*self.driven.0 }
    }

    /// Sets all inputs: [`Driven::set_inputs`].
    ///
    /// # Errors
    /// As [`Driven::set_inputs`].
    pub fn set_inputs(&self, values: &[f64]) -> Result<(), Refusal> {
        self.driven().set_inputs(values)
    }

    /// Ends the run; returns why it cannot be trusted, a sentence each.
    pub fn end(mut self) -> Vec<String> {
        self.run = None;
        let words = |finding: Finding| match finding.remedy.as_str() {
            "" => finding.message,
            remedy => format!("{}: {remedy}", finding.message),
        };
        // SAFETY: the run that had the watch is gone
        let watch = unsafe { self.watch.get() };
        watch.diagnostics().map(Finding::from).map(words).collect()
    }
}
