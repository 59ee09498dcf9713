//! The rivals of the A-buffer among the stages.

use super::Stage;

/// Depth peeling.
pub(super) const PEEL: Stage = Stage {
    name: "peel",
    file: "peel",
    compute: &[
        "peel_clear",
        "peel_nearest",
        "peel_first",
        "peel",
        "peel_behind",
    ],
    fragment: &["peel_nearest_fragment", "peel_first_fragment"],
    contract: "First pass: last[i] is 0, 0, picture[i] 0, 0, 0, 1, and near has nothing. Then for \
        each layer, second and third: the smallest key of every pixel's fragments in front \
        of the opaque key and from last[i] on, which is a key and a triangle; and the \
        smallest triangle with it. Fourth: that layer under picture[i], whose alpha is what \
        goes through; last[i] is its key, and its triangle plus 1; peeled counts it. Where \
        nothing is found, nothing changes. At the end, fifth: over what lies behind.",
};

/// Dual depth peeling.
pub(super) const DUAL: Stage = Stage {
    name: "dual",
    file: "dual",
    compute: &[
        "dual_clear",
        "dual_nearest",
        "dual_first",
        "dual",
        "dual_behind",
    ],
    fragment: &["dual_nearest_fragment", "dual_first_fragment"],
    contract: "As peel, from both ends: between[i] is a key and a triangle from which on fragments \
        are left, and another pair before which they are; at first 0, 0 and the opaque key, \
        0. Fourth: the smallest under picture[i], the largest, if it is another fragment, \
        over back[i], which began with what lies behind. Fifth: picture[i] over back[i].",
};

/// Plain alpha blending.
pub(super) const ALPHA: Stage = Stage {
    name: "alpha",
    file: "alpha",
    compute: &[
        "alpha_clear",
        "alpha_next",
        "alpha",
        "alpha_single",
        "alpha_half",
        "alpha_behind",
    ],
    fragment: &["alpha_fragment"],
    contract: "Fragment: colour and opacity of the triangle, unless it is at or behind the opaque \
        key; the hardware blends them. Then, as the target has 32 or 16 bits, fourth or \
        fifth: what it blended to picture[i]; rows begin at multiples of 256 bytes. Compute: \
        first pass as for peel; for each layer, second: the smallest triangle from last[i] \
        on, in front of the opaque key; third: that over picture[i], last[i] is its number \
        plus 1, and peeled counts it. Sixth, of both: over what lies behind.",
};

/// Weighted blended transparency.
pub(super) const WEIGHTED: Stage = Stage {
    name: "weighted",
    file: "weighted",
    compute: &[
        "weighted_clear",
        "weighted",
        "weighted_behind",
        "weighted_blended",
    ],
    fragment: &["weighted_fragment"],
    contract: "A fragment in front of the opaque key has the weight w = a max(0.01, 3000 (1 - key / \
        2^31)^3). Fragment: a w (colour, 1) to be added, and the opacity a, of which 1 - a \
        is to be multiplied, by the hardware. Compute: first pass, 0, 0, 0, 0 and 1, by \
        their bits, to the five sums of pixel i; second: the same terms, added and \
        multiplied in any order. Third, or fourth of what the hardware blended: the sum of \
        colours over that of weights, at least 2^-64, as far as nothing goes through, over \
        what lies behind.",
};

/// A medium between the layers.
pub(super) const DENSITY: Stage = Stage {
    name: "density",
    file: "density",
    compute: &["density_clear", "density"],
    fragment: &[],
    contract: "First pass: picture[i] is 0, 0, 0, 1, cursors[i] is heads[i]. Second: as resolve, of \
        the sorted list from cursors[i] on; what goes through a layer is multiplied by \
        exp(-sigma.x d), with d the keys to the next layer, or to the opaque surface if \
        there is one, over 2^31. Sets unfinished if it needs another dispatch; cursors[i] is \
        0xfffffffe at the end.",
};

/// Depth of field from the layers.
pub(super) const DEFOCUS: Stage = Stage {
    name: "defocus",
    file: "defocus",
    compute: &[
        "defocus_clear",
        "defocus_layer",
        "defocus",
        "defocus_surface",
        "defocus_behind",
    ],
    fragment: &[],
    contract: "First pass as for density. Then for each layer, second: radius and triangle of the \
        next fragment of list i in front of the opaque key to layer[i], or 0xffffffff twice. \
        Third: each pixel of layer spreads over the square of 2 r + 1 around it; what \
        reaches pixel i, over its sum of opacities if that is more than 1, under picture[i]; \
        beyond the border pixels are those at it. Fourth, followed by the third: the same of \
        opaque surfaces. Fifth: over the background.",
};

/// Fragments at a reduced resolution.
pub(super) const REDUCED: Stage = Stage {
    name: "reduced",
    file: "reduced",
    compute: &[
        "reduced_clear",
        "reduced_layers",
        "reduced_nearest",
        "reduced",
    ],
    fragment: &[],
    contract: "Over the reduced target, first pass as for density; second: as resolve, without what lies \
        behind, to picture[i] with what goes through. Over the full one, where these are reduced_layer: third, \
        pixel i has that of the block of 2^reduction.halvings pixels a side that it is in; fourth, the mean of \
        the four whose middles are around its own, clamped at the border, with the weights of bilinear \
        interpolation over 1 + reduction.falloff d, where d is the difference of opaque_key[i] and guide of \
        each, both at most 2^31, over 2^31. Each over what lies behind, to picture[i].",
};
