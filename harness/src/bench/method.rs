//! Techniques, and what tells them apart.

use serde::{Deserialize, Serialize};
use triptych_gpu::layouts::Layout;

/// How transparent surfaces are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// One walk over the list as it was built.
    Insertion,
    /// The sorted list, up to the last layer that is shown.
    Sort,
    /// Lists laid out by tiles, sorted while they are blended.
    Tiles,
    /// Linked lists by tiles, with a counter for each.
    Linked,
    /// By tiles, without lists in memory.
    Local,
    /// Linked nodes of 16 bytes.
    Packed,
    /// Linked nodes from several counters.
    Regions,
    /// Linked nodes that are in order while they are built.
    Ordered,
    /// Runs of one array, counted first.
    Precalc,
    /// An array and a counter for each pixel.
    Bucket,
    /// Depth peeling: the nearest layer behind the last, again and again.
    Peel,
    /// Dual depth peeling: the nearest and the farthest.
    Dual,
    /// Blended in the order of the triangles.
    Alpha,
    /// Weighted blended transparency.
    Weighted,
    /// Fragments at half of the resolution along x and y,
    Half,
    /// and at a quarter.
    Quarter,
}

impl Method {
    /// Those that draw tile by tile.
    pub const BY_TILES: [Self; 3] = [Self::Tiles, Self::Linked, Self::Local];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Insertion => "insertion",
            Self::Sort => "sort",
            Self::Tiles => "tiles",
            Self::Linked => "linked",
            Self::Local => "local",
            Self::Packed => "packed",
            Self::Regions => "regions",
            Self::Ordered => "ordered",
            Self::Precalc => "precalc",
            Self::Bucket => "bucket",
            Self::Peel => "peel",
            Self::Dual => "dual",
            Self::Alpha => "alpha",
            Self::Weighted => "weighted",
            Self::Half => "half",
            Self::Quarter => "quarter",
        }
    }

    /// Of those that draw tile by tile, bytes of a fragment in a list.
    pub fn entry(self) -> u64 {
        match self {
            Self::Linked => 16,
            Self::Local => 0,
            _ => 8,
        }
    }

    /// Whether it shows some number of the nearest layers, and its figures depend on it.
    pub fn has_layers(self) -> bool {
        self.has_lists() || Self::BY_TILES.contains(&self)
    }

    /// Whether it is the paper's: linked lists, in whichever way they are put in order.
    pub fn has_lists(self) -> bool {
        matches!(self, Self::Insertion | Self::Sort)
    }

    /// Whether its picture is another than that of the layers in order.
    pub fn approximates(self) -> bool {
        matches!(
            self,
            Self::Alpha | Self::Weighted | Self::Packed | Self::Half | Self::Quarter
        )
    }

    /// How it lays the same lists out, if that is all that tells it from others.
    pub fn layout(self) -> Option<Layout> {
        Some(match self {
            Self::Packed => Layout::Packed,
            Self::Regions => Layout::Regions,
            Self::Ordered => Layout::Ordered,
            Self::Precalc => Layout::Precalc,
            Self::Bucket => Layout::Bucket,
            _ => return None,
        })
    }

    /// What holds a fragment of a list, if anything does.
    pub fn node(self) -> Option<&'static str> {
        Some(match self {
            Self::Insertion | Self::Sort | Self::Regions | Self::Half | Self::Quarter => {
                "key, link, triangle, mask; 4 floats"
            }
            Self::Packed => "4 bytes of colour, key, triangle and mask, link",
            Self::Linked => "key, link, triangle, mask",
            Self::Ordered => "key, triangle and mask; link",
            Self::Tiles => "key, triangle",
            Self::Precalc | Self::Bucket => "key, triangle and mask",
            Self::Local | Self::Peel | Self::Dual | Self::Alpha | Self::Weighted => return None,
        })
    }

    /// Bytes of a stored fragment that were demanded: of linked nodes, and of arrays.
    pub fn most_of_fragment(self) -> Option<u64> {
        match self {
            Self::Tiles | Self::Precalc | Self::Bucket => Some(8),
            _ if self.node().is_some() => Some(16),
            _ => None,
        }
    }
}
