//! Reads printed text back: sums of products of factors, by recursive descent.

use super::program::Value;
use super::scalars::Bounded;

type Known = Vec<(String, Bounded)>;

/// Evaluates `name = expression` line by line, and adds each name to `known`.
pub fn evaluate_listing(text: &str, known: &mut Known) -> Result<(), String> {
    for line in text.lines() {
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (name, value) = line.split_once(" = ").ok_or("a line without =")?;
        if lookup(known, name).is_some() {
            return Err(format!("{name} is defined twice"));
        }
        let mut reader = Reader { rest: value, known };
        let value = reader.sum()?;
        if !reader.rest.is_empty() {
            return Err(format!("left over: {}", reader.rest));
        }
        known.push((name.to_string(), value));
    }
    Ok(())
}

pub fn lookup(known: &Known, name: &str) -> Option<Bounded> {
    let entry = known.iter().find(|(n, _)| n == name);
    entry.map(|(_, value)| *value)
}

struct Reader<'a> {
    rest: &'a str,
    known: &'a Known,
}

impl Reader<'_> {
    fn eat(&mut self, token: &str) -> bool {
        let after = self.rest.strip_prefix(token);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn sum(&mut self) -> Result<Bounded, String> {
        let minus = self.eat("-");
        let first = self.product()?;
        let mut sum = if minus { -first } else { first };
        loop {
            if self.eat(" + ") {
                sum = sum + self.product()?;
            } else if self.eat(" - ") {
                sum = sum - self.product()?;
            } else {
                return Ok(sum);
            }
        }
    }

    fn product(&mut self) -> Result<Bounded, String> {
        let mut product = self.factor()?;
        loop {
            if self.eat("*") {
                product = product * self.factor()?;
            } else if self.eat("/") {
                product = product / self.factor()?;
            } else {
                return Ok(product);
            }
        }
    }

    fn factor(&mut self) -> Result<Bounded, String> {
        if self.eat("(") {
            let inner = self.sum()?;
            return self.closed(inner);
        }
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let mut end = self.rest.find(|c| !is_word(c)).unwrap_or(self.rest.len());
        if self.rest.starts_with(|c: char| c.is_ascii_digit()) && self.rest[end..].starts_with('-')
        {
            // The sign of an exponent: 1e-7.
            if self.rest[..end].ends_with('e') {
                let tail = &self.rest[end + 1..];
                end += 1 + tail.find(|c| !is_word(c)).unwrap_or(tail.len());
            }
        }
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest;
        if let Ok(number) = word.parse() {
            return Ok(Bounded::exact(number));
        }
        if !self.eat("(") {
            return lookup(self.known, word).ok_or(format!("unknown {word:?}"));
        }
        let a = self.sum()?;
        let value = match word {
            "sqrt" => a.sqrt(),
            "sin" => a.sin(),
            "cos" => a.cos(),
            "curve1" => a.curve(),
            _ => {
                if !self.eat(", ") {
                    return Err(format!("{word} of one argument"));
                }
                let b = self.sum()?;
                match word {
                    "atan2" => a.atan2(b),
                    "max" => a.max(b),
                    "min" => a.min(b),
                    _ => return Err(format!("unknown function {word:?}")),
                }
            }
        };
        self.closed(value)
    }

    fn closed(&mut self, value: Bounded) -> Result<Bounded, String> {
        match self.eat(")") {
            true => Ok(value),
            false => Err(format!("no ) before {}", self.rest)),
        }
    }
}
