// The numbers of invocations and workgroups. A dispatch has at most 65,535 workgroups a row.

const WORKGROUP: u32 = 64u;

// The number of an invocation.
fn item(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.x + id.y * groups.x * WORKGROUP;
}

// The number of a workgroup.
fn chunk_of(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.x + group.y * groups.x;
}
