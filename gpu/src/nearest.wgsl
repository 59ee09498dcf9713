// A-buffer: the nearest layers of each pixel alone, for `triptych bench`.
// Yang et al. 2010, section 4.1, step 3. Twin: spec/src/abuffer/nearest.rs.
//
// Which layers are kept never depends on the order in which they came.

//#import abuffer

// Layers shown; the host puts in its own number.
const LAYERS: u32 = 1u;

// Nothing is drawn yet: no surfaces, empty lists.
@compute @workgroup_size(WORKGROUP)
fn clear_lists(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    for (var s = 0u; s < frame.samples; s += 1u) {
        atomicStore(&opaque_key[frame.samples * id.x + s], NOTHING);
        atomicStore(&opaque_prim[frame.samples * id.x + s], NOTHING);
    }
    atomicStore(&heads[id.x], EOL);
    if id.x == 0u {
        atomicStore(&counter, 0u);
    }
}

// No sort or resolve has begun.
@compute @workgroup_size(WORKGROUP)
fn clear_progress(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    progress.pixels[id.x] = Progress();
}

// The nearest layers so far, in order.
struct Nearest {
    keys: array<u32, LAYERS>,
    at: array<u32, LAYERS>,
    count: u32,
}

// Whether a node lies before the one in a place; ties by triangle, which is only read
// for them.
fn is_before(nearest: ptr<function, Nearest>, place: u32, key: u32, at: u32) -> bool {
    let other = (*nearest).keys[place];
    if key == other {
        return nodes[at].prim < nodes[(*nearest).at[place]].prim;
    }
    return key < other;
}

// Puts a node in its place. Of a full array the last is dropped, which may be this one.
fn keep(nearest: ptr<function, Nearest>, key: u32, at: u32) {
    var place = (*nearest).count;
    if place == LAYERS {
        if !is_before(nearest, LAYERS - 1u, key, at) {
            return;
        }
        place = LAYERS - 1u;
    } else {
        (*nearest).count = place + 1u;
    }
    while place > 0u && is_before(nearest, place - 1u, key, at) {
        (*nearest).keys[place] = (*nearest).keys[place - 1u];
        (*nearest).at[place] = (*nearest).at[place - 1u];
        place -= 1u;
    }
    (*nearest).keys[place] = key;
    (*nearest).at[place] = at;
}

fn over(seen: vec4<f32>, at: u32) -> vec4<f32> {
    let layer = colours[at];
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// The nearest layers of a list as it was built: one walk, without a sort. The host
// runs it only where no list can take more than STEPS steps, insertion included.
@compute @workgroup_size(WORKGROUP)
fn nearest_layers(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let end = atomicLoad(&opaque_key[id.x]);
    var kept: Nearest;
    kept.count = 0u;
    var at = atomicLoad(&heads[id.x]);
    while at != EOL {
        let node = nodes[at];
        if node.key < end {
            keep(&kept, node.key, at);
        }
        at = node.next;
    }
    var seen = vec4(0.0, 0.0, 0.0, 1.0);
    for (var i = 0u; i < kept.count; i += 1u) {
        seen = over(seen, kept.at[i]);
    }
    picture[id.x] = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
}

// The first layers of a sorted list.
@compute @workgroup_size(WORKGROUP)
fn nearest_layers_sorted(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let end = atomicLoad(&opaque_key[id.x]);
    var at = atomicLoad(&heads[id.x]);
    var seen = vec4(0.0, 0.0, 0.0, 1.0);
    for (var i = 0u; i < LAYERS && at != EOL; i += 1u) {
        let node = nodes[at];
        if node.key >= end {
            break;
        }
        seen = over(seen, at);
        at = node.next;
    }
    picture[id.x] = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
}
