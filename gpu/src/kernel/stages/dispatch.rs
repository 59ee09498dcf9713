//! Stages of the ray tracer.

use super::Stage;

pub(super) const PRIMARY: Stage = Stage {
    name: "primary",
    file: "dispatch",
    compute: &["primary"],
    fragment: &[],
    contract: "Ray i of the next queue, whose hit starts as 0xffffffff, is that of pixel task.first + i, \
        row by row: task.origin and task.direction there, corner + x right + y down in units of 2^-7, \
        rounded to the nearest integers, halves up. It carries the weight 32768 for each colour.",
};

pub(super) const INTERSECT: Stage = Stage {
    name: "intersect",
    file: "dispatch",
    compute: &["intersect_queue"],
    fragment: &[],
    contract: "One invocation: arguments are the workgroups of 64 along x, at most 65,535, along y and \
        along z that go through a queue, and then the number of its rays: the counter, but no more than \
        task.capacity. Rays are searched by trace of grid.wgsl.",
};

pub(super) const LOCATE: Stage = Stage {
    name: "locate",
    file: "dispatch",
    compute: &["locate"],
    fragment: &[],
    contract: "surfaces[i] is the point of triangle hits[i].prim that ray i meets, each coordinate rounded \
        to the nearest integer, halves up, and moved two steps off its face to the side that is seen; its \
        face is twice the triangle, and 1 more if its normal points away from there. Where nothing is met, \
        the face is 0xffffffff.",
};

pub(super) const LIGHT: Stage = Stage {
    name: "light",
    file: "dispatch",
    compute: &["light"],
    fragment: &[],
    contract: "Appends to the next queue, for each of task.lamps lamps that surfaces[i] faces and that gives \
        it anything, a segment to the lamp, which carries its light for the pixel. The counter counts \
        attempts, also those beyond task.capacity, which must not be stored; hits start as 0xffffffff.",
};

pub(super) const REFLECT: Stage = Stage {
    name: "reflect",
    file: "dispatch",
    compute: &["reflect"],
    fragment: &[],
    contract: "Appends to the next queue, as for light, the ray from surfaces[i] into its mirror direction, by \
        the triangle's coarse normal and of 23 bits, if its weight is not 0, ray i has seen fewer than \
        task.depth mirrors, and the direction leaves to the side that is seen.",
};

pub(super) const DEPOSIT: Stage = Stage {
    name: "deposit",
    file: "dispatch",
    compute: &["deposit"],
    fragment: &[],
    contract: "If ray i met nothing, adds to the sums of its pixel, in units of 2^-24, halves up, the light \
        that it carries, or the part of task.background that its weight says. Sums have two words for each \
        colour, low ones first.",
};
