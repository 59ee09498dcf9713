// Sorted lists that are only read, and where each pixel stands in its own.

//#import rival

// End of a list.
const EOL: u32 = 0xffffffffu;

// A pixel that has been through its list. No node has this address: there are fewer.
const DONE: u32 = 0xfffffffeu;

// Steps along a list in one dispatch, as in relink.wgsl.
const STEPS: u32 = 16384u;

struct Node {
    key: u32,
    next: u32,
    prim: u32,
    mask: u32,
}

@group(0) @binding(7) var<storage, read> heads: array<u32>;
@group(0) @binding(8) var<storage, read> nodes: array<Node>;

// The node that comes next.
@group(0) @binding(14) var<storage, read_write> cursors: array<u32>;

// Whether another dispatch is needed.
@group(0) @binding(16) var<storage, read_write> unfinished: atomic<u32>;

// Whether there is a node in front of a pixel's opaque surface.
fn is_visible(at: u32, end: u32) -> bool {
    if at == EOL {
        return false;
    }
    return nodes[at].key < end;
}

// Before the first layer of a pixel.
fn begin_list(pixel: u32) {
    if pixel < band_pixels() {
        picture[pixel] = vec4(0.0, 0.0, 0.0, 1.0);
        cursors[pixel] = heads[pixel];
    }
}
