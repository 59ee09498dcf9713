//! Stage `layers`: every depth of every pixel of every map.

use super::{LdmError, Maps, within};
use crate::grid::Blockers;
use crate::raster::{Fragment, Samples, cover};
use crate::scene::Size;
use crate::vertex::Primitives;

/// Most keys of all maps together: 1 GiB.
pub const KEYS_MAX: u32 = 1 << 28;

/// The maps' lists as runs of one array (Lipowski's l-buffer, 2010; the paper's section 2.1).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Layers {
    /// Where the list of each pixel of each map starts, one more than pixels.
    pub offsets: Vec<u32>,
    /// Depth keys, rising within each list; smaller is nearer to whom the map is seen by.
    pub keys: Vec<u32>,
}

impl Layers {
    /// The list of a pixel of all maps'.
    pub fn list(&self, pixel: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.offsets[pixel as usize + i] as usize);
        &self.keys[start..end]
    }
}

/// Stage `layers` (paper sections 2.1 and 3): front and back faces alike, no depth test; a list
/// holds a key for each triangle that covers the middle of the pixel, equal ones too. Coverage
/// and keys are those of [`crate::raster`], with the map's sub-pixel bits. A triangle that is
/// seen edge-on covers nothing.
///
/// # Errors
/// More than [`KEYS_MAX`] keys, a corner that is no vertex.
pub fn layers(maps: &Maps, blockers: &Blockers) -> Result<Layers, LdmError> {
    let mut layers = Layers {
        offsets: Vec::with_capacity(maps.pixels as usize + 1),
        keys: Vec::new(),
    };
    layers.offsets.push(0);
    let mut drawn = Drawn::new(maps, blockers)?;
    for number in 0..maps.maps.len() {
        let mut found: Vec<(u32, u32)> = Vec::new();
        drawn.cover(number, |pixel, key| found.push((pixel, key)));
        let total = layers.keys.len() as u64 + found.len() as u64;
        within("the number of keys", total, 0, KEYS_MAX.into())?;
        found.sort_unstable();
        let Size { width, height } = maps.maps[number].size;
        layers.add(width * height, &found);
    }
    Ok(layers)
}

impl Layers {
    /// Of no map.
    pub fn none() -> Self {
        Self {
            offsets: vec![0],
            keys: Vec::new(),
        }
    }

    /// Adds the lists of the maps that follow.
    ///
    /// # Errors
    /// More than [`KEYS_MAX`] keys together.
    pub fn append(&mut self, next: Self) -> Result<(), LdmError> {
        let before = self.keys.len() as u64;
        let total = before + next.keys.len() as u64;
        within("the number of keys", total, 0, KEYS_MAX.into())?;
        let before = u32::try_from(before).expect("at most KEYS_MAX");
        let ends = next.offsets.into_iter().skip(1);
        self.offsets.extend(ends.map(|end| before + end));
        self.keys.extend(next.keys);
        Ok(())
    }

    /// One map more, of so many pixels; pixels and keys in order.
    fn add(&mut self, pixels: u32, found: &[(u32, u32)]) {
        let mut rest = found;
        for pixel in 0..pixels {
            let own = rest.partition_point(|(at, _)| *at <= pixel);
            self.keys.extend(rest[..own].iter().map(|(_, key)| key));
            rest = &rest[own..];
            let end = u32::try_from(self.keys.len()).expect("at most KEYS_MAX");
            self.offsets.push(end);
        }
    }
}

/// Triangles as they are drawn into one map after another.
pub(super) struct Drawn<'m> {
    maps: &'m Maps,
    blockers: &'m Blockers,
    primitives: Primitives,
}

impl<'m> Drawn<'m> {
    /// # Errors
    /// A corner that is no vertex.
    pub(super) fn new(maps: &'m Maps, blockers: &'m Blockers) -> Result<Self, LdmError> {
        let missing = |row: &&u32| **row as usize >= blockers.vertices.len();
        if let Some(row) = blockers.triangles.iter().flatten().find(missing) {
            return Err(LdmError::Row(*row));
        }
        Ok(Self {
            maps,
            blockers,
            primitives: Primitives {
                size: Size {
                    width: 0,
                    height: 0,
                },
                bits: maps.bits,
                samples: Samples::ONE,
                snapped: Vec::new(),
                prims: blockers.triangles.clone(),
                source: Vec::new(),
            },
        })
    }

    /// Every pixel of the map that a triangle covers, with its key there: triangle by triangle.
    pub(super) fn cover(&mut self, number: usize, mut emit: impl FnMut(u32, u32)) {
        let map = &self.maps.maps[number];
        self.primitives.size = map.size;
        self.primitives.snapped.clear();
        let places = self.blockers.vertices.iter();
        let places = places.map(|v| self.maps.place(map, *v));
        self.primitives.snapped.extend(places);
        cover(&self.primitives, |Fragment { pixel, key, .. }| {
            emit(pixel, key)
        });
    }
}
