//! Arithmetic in `f32` as loose as WGSL lets it be, at random.

/// Rounds either way, divides within 2.5 units, flushes subnormals or keeps them.
///
/// Sums and products of `f32` are exact in `f64`, or so close that rounding them
/// twice can only pull an exact result onto its neighbour.
pub struct Loose(u64);

impl Loose {
    /// An evaluation of its own for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next choice (SplitMix64).
    pub fn choose(&mut self, ways: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % ways
    }

    /// One of the two neighbours of a number.
    pub fn round(&mut self, exact: f64) -> f32 {
        let near = nearest(exact);
        let other = match f64::from(near).partial_cmp(&exact) {
            Some(std::cmp::Ordering::Less) => near.next_up(),
            Some(std::cmp::Ordering::Greater) => near.next_down(),
            _ => near,
        };
        let taken = if self.choose(2) == 0 { near } else { other };
        self.flush(taken)
    }

    fn flush(&mut self, x: f32) -> f32 {
        if x.is_subnormal() && self.choose(2) == 0 {
            0.0
        } else {
            x
        }
    }

    /// Sum.
    pub fn add(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) + f64::from(b))
    }

    /// Difference.
    pub fn sub(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) - f64::from(b))
    }

    /// Product.
    pub fn mul(&mut self, a: f32, b: f32) -> f32 {
        self.round(f64::from(a) * f64::from(b))
    }

    /// `a * b + c`, rounded once or twice.
    pub fn mul_add(&mut self, a: f32, b: f32, c: f32) -> f32 {
        if self.choose(2) == 0 {
            return self.round(f64::from(a) * f64::from(b) + f64::from(c));
        }
        let product = self.mul(a, b);
        self.add(product, c)
    }

    /// Quotient, up to 2.5 units from the exact one.
    pub fn div(&mut self, a: f32, b: f32) -> f32 {
        let exact = f64::from(a) / f64::from(b);
        let mut x = nearest(exact);
        // A unit in the last place of the exact quotient.
        let unit = exact.abs().log2().floor().exp2() * f64::from(f32::EPSILON);
        let up = self.choose(2) == 0;
        for _ in 0..self.choose(3) {
            let further = if up { x.next_up() } else { x.next_down() };
            if (f64::from(further) - exact).abs() <= 2.5 * unit {
                x = further;
            }
        }
        self.flush(x)
    }

    /// `1 / sqrt(x)`, up to 2 units from the exact one.
    pub fn inverse_sqrt(&mut self, x: f32) -> f32 {
        let exact = 1.0 / f64::from(x).sqrt();
        let mut result = nearest(exact);
        let up = self.choose(2) == 0;
        for _ in 0..self.choose(3) {
            let further = if up {
                result.next_up()
            } else {
                result.next_down()
            };
            // No more than two units in the last place, which are smallest below.
            let unit = f64::from(result.next_down() - result).abs();
            if (f64::from(further) - exact).abs() <= 2.0 * unit {
                result = further;
            }
        }
        result
    }

    /// A sum in some order: from the left, from the right, or in pairs.
    pub fn sum(&mut self, terms: &[f32]) -> f32 {
        let Some((last, rest)) = terms.split_last() else {
            return 0.0;
        };
        if rest.is_empty() {
            return *last;
        }
        let at = match self.choose(3) {
            0 => 1,
            1 => terms.len() - 1,
            _ => terms.len() / 2,
        };
        let (a, b) = (self.sum(&terms[..at]), self.sum(&terms[at..]));
        self.add(a, b)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding to nearest is meant"
)]
fn nearest(x: f64) -> f32 {
    x as f32
}
