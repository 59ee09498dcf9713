// Rays, and what they met.

struct Ray {
    origin: vec3<f32>,
    // 1 if it ends at origin + direction.
    segment: u32,
    direction: vec3<f32>,
    // Whom the answer is for; a search does not read it.
    owner: u32,
}

// What a ray has met, and where it is if it is not done.
struct Hit {
    // The triangle, or NOTHING.
    prim: u32,
    time: f32,
    // FRESH, TRACED, or the cell, ten bits an axis.
    state: u32,
    // Next entry of the cell's list.
    at: u32,
}

const NOTHING: u32 = 0xffffffffu;
const FRESH: u32 = 0xffffffffu;
const TRACED: u32 = 0xfffffffeu;
