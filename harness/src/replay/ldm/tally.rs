//! What was counted on the way, and the hashes of what is too much to hold.

use sha2::{Digest, Sha256};
use triptych_spec::abuffer::NOTHING;
use triptych_spec::ldm::{Hits, Layers, Maps};

/// Counts of all rotations.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Maps that were drawn.
    pub maps: u64,
    /// Of these, those that no light comes through.
    pub dark: u64,
    /// Pixels of maps.
    pub pixels: u64,
    /// Keys in them.
    pub keys: u64,
    /// Keys of the longest list.
    pub longest: u64,
    /// Pixels without a key.
    pub empty: u64,
    /// Pixels with one, whose lists need no order.
    pub ones: u64,
    /// Receivers that found something before them, over all maps.
    pub before: u64,
    /// The same, behind them.
    pub behind: u64,
    offsets: Sha256,
    keys_of: Sha256,
    found: Sha256,
}

impl Tally {
    /// Adds the maps of a rotation.
    pub(super) fn map(&mut self, maps: &Maps, layers: &Layers) {
        self.maps += maps.maps.len() as u64;
        self.pixels += u64::from(maps.pixels);
        self.keys += layers.keys.len() as u64;
        for ends in layers.offsets.windows(2) {
            let length = u64::from(ends[1] - ends[0]);
            self.longest = self.longest.max(length);
            self.empty += u64::from(length == 0);
            self.ones += u64::from(length == 1);
        }
        words(&mut self.offsets, layers.offsets.iter().copied());
        words(&mut self.keys_of, layers.keys.iter().copied());
    }

    /// Adds what a receiver found in the maps of a rotation.
    pub(super) fn hits<'h>(&mut self, found: impl Iterator<Item = &'h Hits>) {
        for hits in found {
            self.before += u64::from(hits.before.is_some());
            self.behind += u64::from(hits.behind.is_some());
            let side = |key: Option<u32>| key.unwrap_or(NOTHING);
            let all = [
                hits.key.cast_unsigned(),
                side(hits.before),
                side(hits.behind),
            ];
            words(&mut self.found, all.into_iter());
        }
    }

    /// Hashes of all offsets, all keys, and all that was found: rotation by rotation, receiver by
    /// receiver, map by map.
    pub fn hashes(&self) -> [(&'static str, String); 3] {
        let digits = |digest: &Sha256| {
            let digest = digest.clone().finalize();
            digest.iter().take(8).map(|b| format!("{b:02x}")).collect()
        };
        [
            ("offsets", digits(&self.offsets)),
            ("keys", digits(&self.keys_of)),
            ("hits", digits(&self.found)),
        ]
    }
}

/// Low byte first.
fn words(digest: &mut Sha256, words: impl Iterator<Item = u32>) {
    for word in words {
        digest.update(word.to_le_bytes());
    }
}
