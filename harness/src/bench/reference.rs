//! What the spec says on one sub-pixel grid: the lists and pictures that are compared with.

use triptych_gpu::frame::Band;
use triptych_spec::abuffer::{Lists, Opaque, Sorted, nearest_layers, resolve};
use triptych_spec::bound::Bounded;
use triptych_spec::raster::{self, Samples};
use triptych_spec::scene::Scene;
use triptych_spec::vertex::{Primitives, primitives};

use super::counts::{Counted, Counts};
use super::error::{Error, psnr};
use super::gpu::Refusal;
use super::pieces::{
    common, from_row, in_order, lists_of_rows, looked_at, of_rows, sorted_rows, within,
};
use crate::compare::{compare, image};
use crate::observe::{Gpu, Observed, Spec};
use crate::plan::Plan;
use crate::replay::spec::{FRAGMENTS_MAX, SpecRun, faces};

/// The spec's picture, with bounds.
pub(super) type Picture = Observed<Spec, Vec<[Bounded; 3]>>;

/// The spec on one grid.
pub(super) struct Grid {
    pub(super) primitives: Primitives,
    /// Colour of each row of `prims`.
    pub(super) faces: Vec<[f32; 4]>,
    pub(super) counts: Counts,
    /// Fragments in the lists of each row of pixels.
    pub(super) rows: Vec<u32>,
    /// The numbers of layers that are measured.
    pub(super) layers: Vec<u32>,
    /// What is compared: the whole target, or, of more fragments than a replay holds, some rows.
    pieces: Vec<Piece>,
    /// Where these are some rows, the surfaces of the whole target.
    surfaces: Option<Opaque>,
}

/// Some rows of a target.
struct Piece {
    band: Band,
    run: SpecRun,
    /// The picture of so many nearest layers, where that is not the exact one.
    pictures: Vec<(u32, Picture)>,
    exact: Picture,
}

impl Piece {
    fn new(band: Band, mut run: SpecRun) -> Self {
        Self {
            band,
            pictures: Vec::new(),
            exact: Observed::new("spec", std::mem::take(&mut run.image)),
            run,
        }
    }

    /// The picture of so many nearest layers.
    fn picture(&self, layers: u32) -> &Picture {
        let drawn = self.pictures.iter().find(|(n, _)| *n == layers);
        drawn.map_or(&self.exact, |(_, picture)| picture)
    }
}

impl Grid {
    /// Runs the spec with all layers.
    ///
    /// # Errors
    /// One line for a scene with more fragments than addresses.
    pub(super) fn new(
        scene: &Scene,
        plan: &Plan,
        (bits, samples): (u32, Samples),
    ) -> Result<Self, String> {
        Self::holding(FRAGMENTS_MAX, scene, plan, (bits, samples))
    }

    /// The same where so many fragments are the most that are held.
    pub(super) fn holding(
        most: u64,
        scene: &Scene,
        plan: &Plan,
        (bits, samples): (u32, Samples),
    ) -> Result<Self, String> {
        let primitives = Primitives {
            samples,
            ..primitives(scene, bits)
        };
        let faces = faces(scene, &primitives);
        let size = primitives.size;
        let few = raster::count(&primitives) <= most;
        let mut grid = Self {
            faces,
            counts: Counts::default(),
            rows: Vec::new(),
            layers: Vec::new(),
            pieces: Vec::new(),
            surfaces: None,
            primitives,
        };
        let mut bands = vec![Band::whole(size)];
        if !few {
            let counted = Counts::counted(scene, &grid.primitives, plan)?;
            bands = looked_at(&counted.rows);
            let Counted {
                counts,
                rows,
                opaque,
            } = counted;
            (grid.counts, grid.rows, grid.surfaces) = (counts, rows, Some(opaque));
        }
        for band in bands {
            let run = SpecRun::new(scene, of_rows(&grid.primitives, band), plan)?;
            if few {
                grid.counts = Counts::of(&run);
                let pixels = run.sorted.offsets[..]
                    .windows(2)
                    .map(|ends| ends[1] - ends[0]);
                let lengths: Vec<u32> = pixels.collect();
                let rows = lengths.chunks(size.width as usize);
                grid.rows = rows.map(|row| row.iter().sum()).collect();
            }
            grid.pieces.push(Piece::new(band, run));
        }
        Ok(grid)
    }

    /// Draws the pictures of fewer layers.
    pub(super) fn draw(&mut self, scene: &Scene, wanted: Option<&[u32]>) {
        let longest = self.counts.longest();
        self.layers = match self.primitives.samples.count() {
            1 => layers(wanted, longest),
            _ => vec![longest],
        };
        for n in self.layers.iter().filter(|n| **n < longest) {
            for piece in &mut self.pieces {
                let SpecRun {
                    primitives,
                    opaque,
                    lists,
                    ..
                } = &piece.run;
                let picture = resolve(scene, primitives, opaque, &nearest_layers(lists, *n));
                piece.pictures.push((*n, Observed::new("spec", picture)));
            }
        }
    }

    /// Those that something shows: not none.
    pub(super) fn shown(&self) -> Vec<u32> {
        let some = self.layers.iter().copied().filter(|n| *n > 0);
        some.collect()
    }

    /// The spec of the whole target, if it holds all of it.
    pub(super) fn whole(&self) -> Option<&SpecRun> {
        let [piece] = &self.pieces[..] else {
            return None;
        };
        let whole = piece.band == Band::whole(self.primitives.size);
        whole.then_some(&piece.run)
    }

    /// The surfaces of the whole target.
    pub(super) fn opaque(&self) -> &Opaque {
        let piece = || &self.pieces[0].run.opaque;
        self.surfaces.as_ref().unwrap_or_else(piece)
    }

    /// What is compared, each by itself: its rows, and what the spec makes of them as a target of
    /// their own.
    pub(super) fn alone(&self) -> impl Iterator<Item = (Band, &SpecRun)> {
        self.pieces.iter().map(|piece| (piece.band, &piece.run))
    }

    /// Fragments in all lists.
    pub(super) fn fragments(&self) -> u64 {
        self.rows.iter().map(|row| u64::from(*row)).sum()
    }

    /// Rows of which every pixel is compared.
    pub(super) fn rows_compared(&self) -> u32 {
        self.pieces.iter().map(|piece| piece.band.rows).sum()
    }

    /// Whether a row of `prims` is opaque.
    pub(super) fn is_opaque(&self, prim: u32) -> bool {
        self.faces[prim as usize][3] >= 1.0
    }

    /// What is wrong with a leg's picture of so many nearest layers.
    pub(super) fn wrong(
        &self,
        label: &str,
        layers: u32,
        method: &str,
        picture: &[[f32; 3]],
    ) -> Option<String> {
        let what = format!("{label}, {layers} layers by {method}");
        let wrong = |piece: &Piece| {
            let seen = picture.get(self.pixels(piece.band)).unwrap_or_default();
            self.unlike(&what, piece.picture(layers), seen, piece.band)
        };
        self.pieces.iter().find_map(wrong)
    }

    /// What is wrong with a picture of some rows that must be like another.
    pub(super) fn unlike(
        &self,
        what: &str,
        must: &Picture,
        seen: &[[f32; 3]],
        band: Band,
    ) -> Option<String> {
        let width = self.primitives.size.width;
        let seen = Observed::<Gpu, _>::new(what, seen);
        let judgement = compare(must, &seen, |a, b| image::compare(a, b, width));
        let (differ, compared) = (judgement.differ(), judgement.compared);
        (differ > 0 || compared == 0).then(|| {
            let first = judgement.described.first().cloned().unwrap_or_default();
            let rows = from_row(band);
            format!("{what}{rows}: {differ} of {compared} channels differ; {first}")
        })
    }

    /// Compares the sorted lists of a band with the spec's: pictures hide an order that changes
    /// no colour.
    pub(super) fn sorted(&self, label: &str, band: Band, mut lists: Lists) -> Result<(), Refusal> {
        let heads = std::mem::take(&mut lists.heads);
        for piece in &self.pieces {
            let Some(rows) = common(piece.band, band) else {
                continue;
            };
            let width = self.primitives.size.width;
            let must: Sorted = sorted_rows(&piece.run.sorted, within(rows, piece.band), width);
            lists.heads = lists_of_rows(&heads, within(rows, band), width);
            let what = format!("{label}, sorted lists{}", from_row(rows));
            in_order(&what, (&must, width), &lists)?;
        }
        Ok(())
    }

    /// How far a picture is from the exact one, where that is known.
    pub(super) fn error(&self, picture: &[[f32; 3]]) -> Error {
        self.error_of(|piece| {
            let seen = picture.get(self.pixels(piece.band)).unwrap_or_default();
            seen.iter().map(|pixel| pixel.map(f64::from)).collect()
        })
    }

    /// The same of the spec's picture of so many nearest layers.
    pub(super) fn error_of_spec(&self, layers: u32) -> Error {
        self.error_of(|piece| {
            let pixels = piece.picture(layers).value.iter();
            pixels.map(|pixel| pixel.map(|c| c.value)).collect()
        })
    }

    fn error_of(&self, seen: impl Fn(&Piece) -> Vec<[f64; 3]>) -> Error {
        let seen: Vec<[f64; 3]> = self.pieces.iter().flat_map(seen).collect();
        let exact = self.pieces.iter().flat_map(|piece| &piece.exact.value);
        psnr(exact, seen)
    }

    /// A band's pixels in a picture of the whole target.
    fn pixels(&self, band: Band) -> std::ops::Range<usize> {
        let width = self.primitives.size.width as usize;
        let first = band.first as usize * width;
        first..first + band.rows as usize * width
    }
}

/// The numbers of layers that are measured on lists of up to `longest`: those that are
/// wanted, else 1, 2, 4, …; and all, of which there are not more.
fn layers(wanted: Option<&[u32]>, longest: u32) -> Vec<u32> {
    let powers = || {
        (0..32)
            .map(|i| 1 << i)
            .take_while(|n| *n < longest)
            .collect()
    };
    let mut layers: Vec<u32> = wanted.map_or_else(powers, <[u32]>::to_vec);
    layers.iter_mut().for_each(|n| *n = longest.min(*n));
    layers.push(longest);
    layers.sort_unstable();
    layers.dedup();
    layers
}

#[cfg(test)]
mod tests;
