// Which of two meetings is first, and when a search has passed one, as far as f32 tells: the
// nearest triangle is one of those whose times the bounds of times leave open. Twin:
// first_exact.wgsl, where none is left open.

// The first of two; the smaller id of two at a time.
fn nearer(ray: Ray, hit: Hit, time: f32, prim: u32) -> Hit {
    let is_first = time < hit.time || (time == hit.time && prim < hit.prim);
    return Hit(select(hit.prim, prim, is_first), select(hit.time, time, is_first), hit.state, hit.at);
}

// What a hit's time must be below to be before a time at which a cell is left.
fn surely(exit: f32) -> f32 {
    return exit;
}
