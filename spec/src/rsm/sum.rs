//! Sums of colours in any order.

use super::Colour;
use crate::bound::Sum as Channel;

/// Adds up colours whose number is only known in the end.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sum([Channel; 3]);

impl Sum {
    pub(super) fn add(&mut self, term: &Colour) {
        for (sum, channel) in self.0.iter_mut().zip(term) {
            sum.add(*channel);
        }
    }

    /// How many there are.
    pub(super) fn terms(&self) -> u32 {
        self.0[0].terms()
    }

    pub(super) fn finish(&self) -> Colour {
        self.0.each_ref().map(Channel::finish)
    }
}
