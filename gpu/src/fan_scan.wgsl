// Where what each of a row of items takes begins: sums of counts before each, for `triptych bench`.

//#import frame
//#import scan

// One for each count.
@group(0) @binding(6) var<storage, read_write> before: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn fan_parts(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    sum_tile(chunk_of(group, groups), lane, frame.items);
}

// One workgroup.
@compute @workgroup_size(WORKGROUP)
fn fan_sums(@builtin(local_invocation_index) lane: u32) {
    sum_tiles(lane, frame.items);
}

@compute @workgroup_size(WORKGROUP)
fn fan_offsets(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let own = part_of_tile(chunk_of(group, groups), lane, frame.items);
    var sum = own.before;
    for (var i = own.first; i < own.end; i += 1u) {
        before[i] = sum;
        sum = plus(sum, atomicLoad(&counts[i]));
    }
}
