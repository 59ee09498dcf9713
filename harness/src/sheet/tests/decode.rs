//! A reader of sheets that shares nothing with what writes them.

use std::io::Read;

use crate::sheet::{Entry, Kind, Pixel};

/// Reads a sheet by the words of `pack.rs`, sharing nothing with it.
pub struct Reader {
    bytes: std::vec::IntoIter<u8>,
}

impl Reader {
    pub fn new(data: &[u8]) -> Self {
        let mut bytes = Vec::new();
        let mut decoder = flate2::read::ZlibDecoder::new(data);
        decoder.read_to_end(&mut bytes).expect("a zlib stream");
        let bytes = bytes.into_iter();
        Self { bytes }
    }

    fn byte(&mut self) -> u8 {
        self.bytes.next().expect("the stream goes on")
    }

    fn number(&mut self) -> i64 {
        let byte = self.byte();
        let low = i64::from(byte & 0x7f);
        if byte < 0x80 {
            low
        } else {
            low + 128 * self.number()
        }
    }

    fn signed(&mut self) -> i64 {
        match self.number() {
            n if n % 2 == 0 => n / 2,
            n => -(n + 1) / 2,
        }
    }

    /// Numbers that are stored as steps.
    fn steps(&mut self, count: i64, step: fn(&mut Self) -> i64) -> Vec<u32> {
        let mut n = 0;
        let mut next = |_| {
            n += step(self);
            u32::try_from(n).expect("32 bits")
        };
        (0..count).map(&mut next).collect()
    }

    fn triangles(&mut self, count: i64) -> Vec<Entry> {
        let prims = self.steps(count, Self::number);
        let instances: Vec<i64> = (0..count).map(|_| self.number()).collect();
        let sources = self.steps(count, Self::signed);
        let mut triangles: Vec<Entry> = (0..prims.len())
            .map(|i| Entry {
                prim: prims[i],
                source: [u32::try_from(instances[i]).expect("32 bits"), sources[i]],
                ..entry(0, 0)
            })
            .collect();
        let mut bits = vec![[0_u32; 4]; triangles.len()];
        for byte in 0..4 {
            for component in 0..4 {
                for colour in &mut bits {
                    colour[component] |= u32::from(self.byte()) << (8 * byte);
                }
            }
        }
        for (triangle, bits) in triangles.iter_mut().zip(bits) {
            triangle.colour = bits.map(f32::from_bits);
        }
        triangles
    }

    pub fn pixels(mut self) -> Vec<Pixel> {
        let [triangles, pixels, lists] = [(); 3].map(|()| self.number());
        let triangles = self.triangles(triangles);
        let numbers = self.steps(pixels, Self::number);
        let lengths: Vec<i64> = (0..pixels * lists).map(|_| self.number()).collect();
        let mut all: Vec<Vec<Entry>> = Vec::new();
        for &length in &lengths {
            let entry = |_| triangles[usize::try_from(self.number()).expect("a triangle")];
            all.push((0..length).map(entry).collect());
        }
        for list in &mut all {
            let keys = self.steps(list.len() as i64, Self::signed);
            list.iter_mut().zip(keys).for_each(|(e, key)| e.key = key);
        }
        for entry in all.iter_mut().flatten() {
            let n = self.number();
            entry.mask = u32::try_from(n / 16).expect("32 bits");
            entry.kind = KINDS[usize::try_from(n % 16).expect("a kind")];
        }
        assert_eq!(self.bytes.next(), None, "nothing is left");
        let mut all = all.into_iter();
        let own = |n| {
            (
                n,
                all.by_ref()
                    .take(usize::try_from(lists).expect("one or two"))
                    .collect(),
            )
        };
        numbers.into_iter().map(own).collect()
    }
}

/// Kinds by their numbers.
pub const KINDS: [Kind; 9] = [
    Kind::Listed,
    Kind::Opaque,
    Kind::Astray,
    Kind::Edge,
    Kind::Unresolved,
    Kind::Invented,
    Kind::Depth,
    Kind::Missed,
    Kind::MissedUnjudged,
];

/// An entry to change.
pub fn entry(prim: u32, key: u32) -> Entry {
    Entry {
        prim,
        source: [0, prim],
        key,
        mask: 1,
        colour: [0.25, 0.5, 1.0, 0.5],
        kind: Kind::Listed,
    }
}
