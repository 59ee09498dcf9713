//! Sums in any order.

use super::Colour;
use crate::bound::{Bounded, TINY, gamma};

/// Adds up colours whose number is only known in the end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum {
    value: [f64; 3],
    /// Of the terms, each as large as an evaluation may have it.
    size: [f64; 3],
    bound: [f64; 3],
    terms: u32,
}

impl Sum {
    pub(super) fn add(&mut self, term: &Colour) {
        for (i, channel) in term.iter().enumerate() {
            self.value[i] += channel.value;
            self.size[i] += channel.value.abs() + channel.bound;
            self.bound[i] += channel.bound;
        }
        self.terms += 1;
    }

    /// How many there are.
    pub(super) fn terms(&self) -> u32 {
        self.terms
    }

    /// The sum of `n` terms in any order is `n - 1` additions: a term meets at most as many
    /// roundings (Higham, section 4.2), and each sum may be flushed. The first is added to
    /// 0, exactly. Fusing a product into an addition only spares a rounding.
    pub(super) fn finish(&self) -> Colour {
        let additions = self.terms.saturating_sub(1);
        [0, 1, 2].map(|i| {
            // Sums of nothing but zeros are exact.
            let flushed = if self.size[i] == 0.0 { 0.0 } else { TINY };
            let rounding = gamma(additions) * self.size[i] + f64::from(additions) * flushed;
            let bound = self.bound[i] + rounding;
            let defined = self.size[i] + bound <= f64::from(f32::MAX);
            Bounded {
                value: self.value[i],
                bound: if defined { bound } else { f64::INFINITY },
            }
        })
    }
}
