//! Techniques, and what tells them apart.

use serde::{Deserialize, Serialize};

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
    /// Depth peeling: the nearest layer behind the last, again and again.
    Peel,
    /// Dual depth peeling: the nearest and the farthest.
    Dual,
    /// Blended in the order of the triangles.
    Alpha,
    /// Weighted blended transparency.
    Weighted,
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
            Self::Peel => "peel",
            Self::Dual => "dual",
            Self::Alpha => "alpha",
            Self::Weighted => "weighted",
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
        matches!(self, Self::Alpha | Self::Weighted)
    }
}
