// A-buffer with several samples a pixel: the sorted lists over what lies behind each sample,
// and the mean. Yang et al. 2010, section 4.1.2. Twin: spec/src/abuffer/multisample.rs.
//
// By pixel: a list is followed once, for all samples. By sample: once for each, into a
// multisampled target, so to say, whose mean a last pass takes. The target is `picture`, in
// which the samples of a pixel follow each other; the mean replaces the first.

//#import abuffer
//#import mean

// A dispatch follows a list for so many nodes: an inner loop has all samples of each.
const NODES: u32 = STEPS / SAMPLES_MAX;

// What the first sample's opacity says once it is done, if all samples are like it.
const ALIKE: f32 = 2.0;

fn all_samples() -> u32 {
    return (1u << frame.samples) - 1u;
}

// Whether a node shows at a sample, as far as that its list knows: what a later depth test
// would hide does not.
fn shows(node: Node, pixel: u32, s: u32) -> bool {
    let end = atomicLoad(&opaque_key[frame.samples * pixel + s]);
    if frame.order == 1u {
        return node.key < end;
    }
    if (node.mask >> s & 1u) == 0u {
        return false;
    }
    return end == NOTHING || key_at(node.prim, pixel, s, node.key) < end;
}

fn over(seen: vec4<f32>, layer: vec4<f32>) -> vec4<f32> {
    return vec4(seen.rgb + seen.a * layer.a * layer.rgb, seen.a * (1.0 - layer.a));
}

// Stage resolve by pixel. As long as all layers cover all samples, these are alike and one
// stands for them; `merged` says that this is still so.
@compute @workgroup_size(WORKGROUP)
fn resolve_pixel(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var p = progress.pixels[id.x];
    if p.state == DONE {
        return;
    }
    let first = frame.samples * id.x;
    var seen: array<vec4<f32>, SAMPLES_MAX>;
    for (var s = 0u; s < frame.samples; s += 1u) {
        seen[s] = select(picture[first + s], vec4(0.0, 0.0, 0.0, 1.0), vec4(p.run == 0u));
    }
    if p.run == 0u {
        p = Progress(frame.once, EOL, atomicLoad(&heads[id.x]), EOL, 0u, 0u, 1u, FIND);
    }
    var i = 0u;
    while i < NODES && p.left != EOL {
        let node = nodes[p.left];
        let layer = faces[node.prim];
        if p.merged == 1u && (node.mask & all_samples()) == all_samples() {
            seen[0] = over(seen[0], layer);
        } else {
            for (var s = 1u; s < frame.samples && p.merged == 1u; s += 1u) {
                seen[s] = seen[0];
            }
            p.merged = 0u;
            for (var s = 0u; s < frame.samples; s += 1u) {
                if shows(node, id.x, s) {
                    seen[s] = over(seen[s], layer);
                }
            }
        }
        p.left = node.next;
        i += 1u;
    }
    if p.left != EOL {
        atomicStore(&progress.unfinished, 1u);
        for (var s = 0u; s < frame.samples; s += 1u) {
            picture[first + s] = seen[s];
        }
    } else {
        var colours: array<vec3<f32>, SAMPLES_MAX>;
        for (var s = 0u; s < frame.samples; s += 1u) {
            let front = seen[select(s, 0u, p.merged == 1u)];
            colours[s] = front.rgb + front.a * behind(first + s);
        }
        picture[first] = mean(&colours);
        p.state = DONE;
    }
    progress.pixels[id.x] = p;
}

// Before stage resolve by the true depth of each sample: nodes get their keys at this sample,
// those that do not cover it the last of all. The lists are then out of order.
@compute @workgroup_size(WORKGROUP)
fn key_samples(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    var p = progress.pixels[id.x];
    if p.run == 0u {
        p = Progress(EOL, EOL, atomicLoad(&heads[id.x]), EOL, 0u, 0u, 1u, FIND);
    }
    for (var i = 0u; i < STEPS && p.left != EOL; i += 1u) {
        let node = nodes[p.left];
        let covers = (node.mask >> frame.sample & 1u) == 1u;
        var key = NOTHING;
        if covers {
            key = key_at(node.prim, id.x, frame.sample, node.key);
        }
        nodes[p.left].key = key;
        p.left = node.next;
    }
    if p.left != EOL {
        atomicStore(&progress.unfinished, 1u);
    }
    progress.pixels[id.x] = p;
}

// Whether all samples of a pixel have the same surface behind them.
fn same_behind(pixel: u32) -> bool {
    let first = frame.samples * pixel;
    let prim = atomicLoad(&opaque_prim[first]);
    for (var s = 1u; s < frame.samples; s += 1u) {
        if atomicLoad(&opaque_prim[first + s]) != prim {
            return false;
        }
    }
    return true;
}

// Whether it is still possible that all samples are alike; by their own keys, samples may
// have two layers in different orders, although both cover them all.
fn may_be_alike(head: u32) -> bool {
    if frame.once == 0u {
        return false;
    }
    var several = false;
    if head != EOL {
        several = nodes[head].next != EOL;
    }
    return !(several && frame.order == 1u);
}

// Stage resolve by sample, one of them in each turn.
@compute @workgroup_size(WORKGROUP)
fn resolve_sample(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let first = frame.samples * id.x;
    let at = first + frame.sample;
    if frame.sample > 0u && picture[first].a == ALIKE {
        return;
    }
    var p = progress.pixels[id.x];
    if p.state == DONE {
        return;
    }
    var seen = picture[at];
    if p.run == 0u {
        let head = atomicLoad(&heads[id.x]);
        p = Progress(u32(may_be_alike(head)), EOL, head, EOL, 0u, 0u, 1u, FIND);
        seen = vec4(0.0, 0.0, 0.0, 1.0);
    }
    for (var i = 0u; i < NODES && p.left != EOL; i += 1u) {
        let node = nodes[p.left];
        if shows(node, id.x, frame.sample) {
            seen = over(seen, faces[node.prim]);
        }
        if (node.mask & all_samples()) != all_samples() {
            p.merged = 0u;
        }
        p.left = node.next;
    }
    if p.left != EOL {
        atomicStore(&progress.unfinished, 1u);
    } else {
        let alike = frame.sample == 0u && p.merged == 1u && same_behind(id.x);
        seen = vec4(seen.rgb + seen.a * behind(at), select(1.0, ALIKE, alike));
        p.state = DONE;
    }
    picture[at] = seen;
    progress.pixels[id.x] = p;
}

// The mean of each pixel's samples, as hardware resolves a multisampled target.
@compute @workgroup_size(WORKGROUP)
fn resolve_mean(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= band_pixels() {
        return;
    }
    let first = frame.samples * id.x;
    let alike = picture[first].a == ALIKE;
    var colours: array<vec3<f32>, SAMPLES_MAX>;
    for (var s = 0u; s < frame.samples; s += 1u) {
        colours[s] = picture[first + select(s, 0u, alike)].rgb;
    }
    picture[first] = mean(&colours);
}
