//! Mean, variance and correlation of a stream of numbers \[B. P. Welford, Technometrics 4, 419 (1962)\].

/// Count, mean, variance, minimum and maximum of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Number of values so far.
    pub count: u64,
    mean: f64,
    squares: f64,
    /// Least value, NaN if there are none.
    pub minimum: f64,
    /// Largest value, NaN if there are none.
    pub maximum: f64,
}

impl Default for Moments {
    fn default() -> Self {
        Moments {
            count: 0,
            mean: 0.0,
            squares: 0.0,
            minimum: f64::NAN,
            maximum: f64::NAN,
        }
    }
}

impl Moments {
    /// Adds a finite value.
    pub fn add(&mut self, value: f64) {
        self.count += 1;
        let difference = value - self.mean;
        self.mean += difference / self.count as f64;
        self.squares += difference * (value - self.mean);
        // the first value replaces NaN
        self.minimum = self.minimum.min(value);
        self.maximum = self.maximum.max(value);
    }

    /// The mean, NaN if there are no values.
    pub fn mean(&self) -> f64 {
        if self.count == 0 { f64::NAN } else { self.mean }
    }

    /// The standard deviation of the sample, NaN for fewer than two values.
    pub fn deviation(&self) -> f64 {
        if self.count < 2 {
            return f64::NAN;
        }
        (self.squares / (self.count - 1) as f64).sqrt()
    }
}

/// Pearson's correlation of two columns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correlation {
    count: f64,
    means: [f64; 2],
    squares: [f64; 2],
    product: f64,
}

impl Correlation {
    /// Adds a pair of finite values.
    pub fn add(&mut self, x: f64, y: f64) {
        self.count += 1.0;
        let before = [x - self.means[0], y - self.means[1]];
        self.means[0] += before[0] / self.count;
        self.means[1] += before[1] / self.count;
        let after = [x - self.means[0], y - self.means[1]];
        self.squares[0] += before[0] * after[0];
        self.squares[1] += before[1] * after[1];
        self.product += before[0] * after[1];
    }

    /// The correlation, from −1 to 1; NaN if one of the columns does not vary.
    pub fn value(&self) -> f64 {
        let scale = self.squares[0].sqrt() * self.squares[1].sqrt();
        if scale > 0.0 {
            (self.product / scale).clamp(-1.0, 1.0)
        } else {
            f64::NAN
        }
    }
}
