//! Pictures of lists: passes over what is built, and whole frames of the nearest layers alone.

use triptych_spec::abuffer::{EOL, Lists};

use super::room::{Room, Step};
use super::{Layout, Listing, ordered, precalc};
use crate::abuffer::{STEPS, dispatches};
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::raster::Path;

/// A dispatch that blends begins with nothing. Twin: `BEGINS` in `listing.wgsl`.
pub const BEGINS: u32 = 1;

/// It ends with what lies behind. Twin: `ENDS` in `listing.wgsl`.
pub const ENDS: u32 = 2;

/// Passes over nearer ranges of depth have shown layers before. Twin: `FOLLOWS` in `listing.wgsl`.
pub const FOLLOWS: u32 = 4;

/// Others are to come. Twin: `GOES_ON` in `listing.wgsl`.
pub const GOES_ON: u32 = 8;

/// Layers of a list in one dispatch where pixels have several samples. Twin: `SAMPLED` in `sampled.wgsl`.
pub const SAMPLED: u32 = 2048;

impl Room<'_, '_> {
    /// What each turn of samples is told: the compute paths blend all samples of a pixel at once, the
    /// fragment path one after another, as into a multisampled target.
    fn turns(&self) -> Vec<Listing> {
        let samples = self.frame.samples;
        let each = match self.rasterizer.path {
            Path::Fragment => 1,
            Path::Compute | Path::Native => samples,
        };
        let turn = |sample| Listing {
            sample,
            samples: each,
            ..self.listing
        };
        (0..samples).step_by(each as usize).map(turn).collect()
    }

    /// A kernel of the picture over all pixels: that of the same name for several samples, if there are.
    fn of_picture(&self, entry: &str, listing: Listing) -> Result<Step, GpuError> {
        let file = self.layout.file();
        let groups = self.pixels().div_ceil(WORKGROUP);
        let pass = match self.frame.samples {
            1 => self.pass(entry, listing, groups),
            _ => {
                let (file, entry) = (format!("{file}_samples"), format!("{entry}_samples"));
                self.pass_of(&file, &entry, listing, groups)
            }
        };
        pass.map(Step::Other)
    }

    /// What follows the last turn, unless it was the only one: the mean of each pixel's samples.
    fn mean(&self, turns: &[Listing]) -> Result<Option<Step>, GpuError> {
        if turns.len() < 2 {
            return Ok(None);
        }
        let groups = self.pixels().div_ceil(WORKGROUP);
        let pass = self.pass_of("multisample", "resolve_mean", self.listing, groups)?;
        Ok(Some(Step::Other(pass)))
    }

    /// Blends lists in order, of at most `longest` entries, by a kernel that can begin at any: `flags` of
    /// the first dispatch and of the last.
    pub(super) fn blend_from(
        &self,
        entry: &str,
        longest: u32,
        flags: u32,
    ) -> Result<Vec<Step>, GpuError> {
        let most = match self.frame.samples {
            1 => u32::try_from(STEPS).expect("a word"),
            _ => SAMPLED,
        };
        let turns = self.turns();
        let mut steps = Vec::new();
        for (at, turn) in turns.iter().enumerate() {
            for first in (0..longest.max(1)).step_by(most as usize) {
                let mut own = flags & FOLLOWS;
                if first == 0 {
                    own |= flags & BEGINS;
                }
                if longest.saturating_sub(first) <= most {
                    own |= flags & ENDS;
                    if at + 1 == turns.len() {
                        own |= flags & GOES_ON;
                    }
                }
                let listing = Listing {
                    first,
                    flags: own,
                    ..*turn
                };
                steps.push(self.of_picture(entry, listing)?);
            }
        }
        if flags & ENDS != 0 {
            steps.extend(self.mean(&turns)?);
        }
        Ok(steps)
    }

    /// As many dispatches of a kernel as lists of that length may take; those that come after the last do
    /// nothing.
    fn until_done(
        &self,
        longest: u32,
        pass: impl Fn() -> Result<Step, GpuError>,
    ) -> Result<Vec<Step>, GpuError> {
        let groups = self.pixels().div_ceil(WORKGROUP);
        let clear = self.pass_of("nearest", "clear_progress", self.listing, groups)?;
        let again = (0..dispatches(longest)).map(|_| pass());
        std::iter::once(Ok(Step::Other(clear)))
            .chain(again)
            .collect()
    }

    /// Puts lists of at most `longest` entries in order, of `all` in memory.
    pub(super) fn order(&mut self, longest: u32, all: u32) -> Result<Vec<Step>, GpuError> {
        let (file, entry) = match self.layout {
            Layout::Bucket | Layout::Precalc => return self.rank(longest, all),
            Layout::Ordered => return Ok(Vec::new()),
            Layout::Packed => ("packed", "packed_sort"),
            Layout::Regions => ("abuffer", "sort"),
        };
        let groups = self.pixels().div_ceil(WORKGROUP);
        let pass = || {
            self.pass_of(file, entry, self.listing, groups)
                .map(Step::Other)
        };
        self.until_done(longest, pass)
    }

    /// Blends lists of at most `longest` entries that are in order.
    pub(super) fn blend(&self, longest: u32) -> Result<Vec<Step>, GpuError> {
        let entry = match self.layout {
            Layout::Bucket | Layout::Precalc => {
                return self.blend_from("rank_blend", longest, BEGINS | ENDS);
            }
            Layout::Ordered => return self.blend_from("ordered_blend", longest, BEGINS | ENDS),
            Layout::Packed => "packed_resolve",
            Layout::Regions => "regions_blend",
        };
        // Kernels with an inner loop over samples stop for breath after so many fewer layers.
        let each = match self.frame.samples {
            1 => 1,
            _ => u32::try_from(STEPS).expect("a word") / SAMPLED,
        };
        let turns = self.turns();
        let mut steps = Vec::new();
        for turn in &turns {
            let pass = || self.of_picture(entry, *turn);
            steps.extend(self.until_done(longest.saturating_mul(each), pass)?);
        }
        if self.layout == Layout::Packed && each > 1 {
            steps.push(self.of_picture("packed_taken", self.listing)?);
        }
        steps.extend(self.mean(&turns)?);
        Ok(steps)
    }

    /// Empties lists. Filling runs uses their counts up, and blending takes packed nodes.
    pub(super) fn empty(&self) -> Result<Vec<Step>, GpuError> {
        Ok(match self.layout {
            Layout::Bucket => vec![Step::Other(self.per_pixel("bucket_clear", self.listing)?)],
            Layout::Regions => vec![Step::Other(self.per_pixel("regions_clear", self.listing)?)],
            Layout::Ordered => vec![ordered::clear(self)?],
            Layout::Precalc | Layout::Packed => Vec::new(),
        })
    }

    /// Builds lists in buffers with room for them.
    pub(super) fn build(&self) -> Result<Vec<Step>, GpuError> {
        match self.layout {
            Layout::Precalc => {
                let mut steps = precalc::count(self)?;
                steps.extend(self.draw("precalc_fill")?);
                Ok(steps)
            }
            Layout::Ordered => ordered::draw(self),
            layout => self.draw(layout.name()),
        }
    }

    /// A frame of so many nearest layers alone, in the buffers of one of all, whose longest list has
    /// `longest` entries of `all` in memory.
    pub(super) fn nearest(
        &mut self,
        layers: u32,
        (longest, all): (u32, u32),
    ) -> Result<Vec<Step>, GpuError> {
        let listing = self.listing;
        self.listing.layers = layers;
        let mut steps = self.empty()?;
        steps.extend(self.build()?);
        steps.extend(self.order(longest, all)?);
        steps.extend(self.blend(longest)?);
        self.listing = listing;
        Ok(steps)
    }

    /// Pictures of so many nearest layers each, as [`Self::nearest`] makes them.
    pub(super) fn pictures(
        &mut self,
        layers: &[u32],
        lists: (u32, u32),
    ) -> Result<Vec<Vec<[f32; 3]>>, GpuError> {
        let mut pictures = Vec::new();
        for n in layers {
            let steps = self.nearest(*n, lists)?;
            self.submit(&steps)?;
            pictures.push(self.picture()?);
        }
        Ok(pictures)
    }
}

/// Entries of the longest of lists that end.
pub(super) fn longest(lists: &Lists) -> u32 {
    let length = |head: &u32| {
        let next = |at: &u32| lists.nodes.get(*at as usize).map(|node| node.next);
        let all = std::iter::successors(Some(*head), next).take_while(|at| *at != EOL);
        all.take(lists.nodes.len()).count()
    };
    let most = lists.heads.iter().map(length).max().unwrap_or(0);
    u32::try_from(most).expect("addresses are words")
}
