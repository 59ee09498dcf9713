// Sums over a workgroup.

// Sums that saturate, so that too many entries are seen to be too many.
fn plus(a: u32, b: u32) -> u32 {
    return select(a + b, 0xffffffffu, a + b < a);
}

var<workgroup> parts: array<u32, 64>;

// The sum of all parts before an invocation's own. All of a workgroup come along.
fn parts_before(lane: u32, part: u32) -> u32 {
    parts[lane] = part;
    workgroupBarrier();
    for (var reach = 1u; reach < WORKGROUP; reach *= 2u) {
        let sum = plus(parts[lane], select(0u, parts[max(lane, reach) - reach], lane >= reach));
        workgroupBarrier();
        parts[lane] = sum;
        workgroupBarrier();
    }
    return select(0u, parts[max(lane, 1u) - 1u], lane > 0u);
}
