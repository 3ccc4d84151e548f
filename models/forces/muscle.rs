//! A muscle of Hill's kind on a straight line from origin to insertion, with a tendon that does not stretch.
//!
//! F = F_max (a f_l(λ) f_v(ν) + f_p(λ)),   λ = (L − L_tendon)/l_opt,   ν = L̇/(v_max l_opt)
//!
//! a is the activation, which follows the excitation u with a delay: a state of the force.
//!
//! F. E. Zajac: Muscle and tendon: properties, models, scaling, and application to biomechanics and motor control.
//! Critical Reviews in Biomedical Engineering 17, 1989. — D. G. Thelen: Adjustment of muscle mechanics model parameters
//! to simulate dynamic contractions in older adults. Journal of Biomechanical Engineering 125, 2003, whose shapes and
//! constants for young adults are used here.

/// The tension in the muscle, and the rate of its activation.
pub fn muscle<T: Real>(input: &Input<T>) -> Output<T> {
    let p = input.parameters;
    let activation = input.states.activation;

    let stretch = (input.lines.muscle.length - p.tendon) / p.optimum;
    let speed = input.lines.muscle.rate / (p.fastest * p.optimum);
    let active = activation * force_length(stretch) * force_velocity(speed);
    let force = p.strength * (active + passive(stretch));

    let mut output = Output::zero();
    output.lines.muscle.tension = force;
    output.states.activation.rate = activation_rate(p.excitation, activation, p.rise, p.decay);
    output
}

/// ȧ = (u − a)/τ: a muscle rises with τ = τ_rise (0.5 + 1.5 a) and falls with τ = τ_decay/(0.5 + 1.5 a).
fn activation_rate<T: Real>(excitation: T, activation: T, rise: T, decay: T) -> T {
    let num = T::from_f64;
    let u = excitation.max(num(0.0)).min(num(1.0));
    let slowing = num(0.5) + num(1.5) * activation;
    let time = T::select(activation.lt(u), rise * slowing, decay / slowing);
    (u - activation) / time
}

/// Active force against length at rest: exp(−(λ − 1)²/γ), γ = 0.45.
fn force_length<T: Real>(stretch: T) -> T {
    let apart = stretch - T::from_f64(1.0);
    (apart * apart * T::from_f64(-1.0 / 0.45)).exp()
}

/// Force against speed, ν < 0 where the muscle shortens: Hill's hyperbola (1 + ν)/(1 − ν/A), A = 0.25, down to 0 at the
/// fastest shortening; lengthening, the hyperbola of the same slope at ν = 0 that tends to 1.4.
fn force_velocity<T: Real>(speed: T) -> T {
    let num = T::from_f64;
    let (zero, one) = (num(0.0), num(1.0));
    // each side is evaluated on its own side of 0 only, so that neither denominator vanishes
    let (shortening, lengthening) = (speed.min(zero).max(num(-1.0)), speed.max(zero));
    let shortens = (one + shortening) / (one - num(1.0 / 0.25) * shortening);
    let slope = num((1.0 + 1.0 / 0.25) / (1.4 - 1.0));
    let lengthens = (one + num(1.4) * slope * lengthening) / (one + slope * lengthening);
    T::select(speed.lt(zero), shortens, lengthens)
}

/// What holds the muscle without activation: (exp(k (λ − 1)/ε) − 1)/(exp k − 1), k = 5, ε = 0.6, where it is stretched.
fn passive<T: Real>(stretch: T) -> T {
    let num = T::from_f64;
    let strain = (stretch - num(1.0)).max(num(0.0));
    ((strain * num(5.0 / 0.6)).exp() - num(1.0)) / (num(5.0).exp() - num(1.0))
}
