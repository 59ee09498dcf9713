// What an adapter can do at most, for `triptych bench`: bytes copied, atomics done.

//#import frame
//#import counter

@group(0) @binding(5) var<storage, read> source: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read_write> copied: array<vec4<u32>>;
@group(0) @binding(7) var<storage, read_write> heads: array<atomic<u32>>;
@group(0) @binding(8) var<storage, read_write> links: array<u32>;

// Workgroups in rows, as one row has at most 65,535 of them.
fn number(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.y * groups.x * WORKGROUP + id.x;
}

// Reads and writes 16 bytes.
@compute @workgroup_size(WORKGROUP)
fn copy(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = number(id, groups);
    if i < frame.items {
        copied[i] = source[i];
    }
}

// Two atomics, as a fragment does that is put into a list: an address from the one
// counter, and the exchange at its pixel's head; neighbours have neighbouring heads.
@compute @workgroup_size(WORKGROUP)
fn exchange(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let i = number(id, groups);
    if i < frame.items {
        let address = claim();
        if address < frame.capacity {
            links[address] = atomicExchange(&heads[i % frame.width], address);
        }
    }
}
