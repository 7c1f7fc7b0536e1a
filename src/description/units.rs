//! Units by their names: exponents of the SI base units, and factors of display units
//! (FMI 2.0 section 2.2.2).
//!
//! A unit's name is a product of symbols, each with an optional exponent, joined by dots; what
//! follows a slash divides: `kg.m2`, `N.m.s/rad`, `1/s2`.

/// Exponents of the base units in the order kg, m, s, A, rad.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exponents {
    pub kg: i32,
    pub m: i32,
    pub s: i32,
    pub a: i32,
    pub rad: i32,
}

impl Exponents {
    const fn new(kg: i32, m: i32, s: i32, a: i32, rad: i32) -> Self {
        Self { kg, m, s, a, rad }
    }

    /// The exponents of the unit called `name`, `None` if a symbol is unknown.
    ///
    /// All symbols are coherent SI units, so the factor to the base units is always 1.
    pub fn of(name: &str) -> Option<Self> {
        let (numerator, denominator) = name.split_once('/').unwrap_or((name, ""));
        let mut total = Self::default();
        for (product, sign) in [(numerator, 1), (denominator, -1)] {
            for factor in product.split('.').filter(|factor| !factor.is_empty() && *factor != "1") {
                let digits = factor.find(|c: char| c.is_ascii_digit()).unwrap_or(factor.len());
                let (symbol, exponent) = factor.split_at(digits);
                let power = sign * if exponent.is_empty() { 1 } else { exponent.parse::<i32>().ok()? };
                let unit = symbol_exponents(symbol)?;
                total.kg += power * unit.kg;
                total.m += power * unit.m;
                total.s += power * unit.s;
                total.a += power * unit.a;
                total.rad += power * unit.rad;
            }
        }
        Some(total)
    }
}

fn symbol_exponents(symbol: &str) -> Option<Exponents> {
    Some(match symbol {
        "kg" => Exponents::new(1, 0, 0, 0, 0),
        "m" => Exponents::new(0, 1, 0, 0, 0),
        "s" => Exponents::new(0, 0, 1, 0, 0),
        "A" => Exponents::new(0, 0, 0, 1, 0),
        "rad" => Exponents::new(0, 0, 0, 0, 1),
        "N" => Exponents::new(1, 1, -2, 0, 0),
        "J" => Exponents::new(1, 2, -2, 0, 0),
        "W" => Exponents::new(1, 2, -3, 0, 0),
        "V" => Exponents::new(1, 2, -3, -1, 0),
        "Ohm" => Exponents::new(1, 2, -3, -2, 0),
        "H" => Exponents::new(1, 2, -2, -2, 0),
        _ => return None,
    })
}

/// How many of the display unit make one of the unit (`DisplayUnit factor`), `None` if the pair is unknown.
pub fn display_factor(unit: &str, display: &str) -> Option<f64> {
    Some(match (unit, display) {
        ("m", "cm") | ("m/s", "cm/s") => 100.0,
        ("m", "mm") | ("s", "ms") => 1000.0,
        ("rad", "deg") | ("rad/s", "deg/s") => 180.0 / std::f64::consts::PI,
        _ => return None,
    })
}
