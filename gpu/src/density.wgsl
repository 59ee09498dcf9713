// Sorted lists with a medium between the layers. Yang et al. 2010, section 5.
// Twin: spec/src/abuffer/density.rs.

//#import sorted

// Units of one over the depth range.
@group(0) @binding(13) var<uniform> sigma: vec4<f32>;

// What is left of light over a difference of keys.
fn attenuation(keys: u32) -> f32 {
    return exp(-(sigma.x * (f32(keys) * 0x1p-31f)));
}

// Stage density: as resolve, and between two layers, or the last and an opaque surface, light
// is attenuated. A dispatch goes on where the one before stopped.
@compute @workgroup_size(WORKGROUP)
fn density(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var at = cursors[id.x];
    if at == DONE {
        return;
    }
    var seen = picture[id.x];
    let end = opaque_key[id.x];
    var i = 0u;
    while i < STEPS && is_visible(at, end) {
        let node = nodes[at];
        seen = under(seen, node.prim);
        at = node.next;
        if is_visible(at, end) {
            seen.a *= attenuation(nodes[at].key - node.key);
        } else if opaque_prim[id.x] != NOTHING {
            seen.a *= attenuation(end - node.key);
        }
        i += 1u;
    }
    if i == STEPS {
        atomicStore(&unfinished, 1u);
    } else {
        seen = vec4(seen.rgb + seen.a * behind(id.x), 1.0);
        at = DONE;
    }
    picture[id.x] = seen;
    cursors[id.x] = at;
}

@compute @workgroup_size(WORKGROUP)
fn density_clear(@builtin(global_invocation_id) id: vec3<u32>) {
    begin_list(id.x);
}
