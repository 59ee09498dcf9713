// The counter that hands out addresses (Yang et al. 2010, section 3.1).

// Attempts so far.
@group(0) @binding(4) var<storage, read_write> counter: atomic<u32>;

// The next free address. It may lie beyond the capacity: the attempt is counted,
// the caller must not write.
//
// The counter cannot wrap: past SATURATED every claim gives its count back, so that
// it stays within the number of invocations in flight of that value.
const SATURATED: u32 = 0x80000000u;

fn claim() -> u32 {
    let address = atomicAdd(&counter, 1u);
    if address >= SATURATED {
        atomicSub(&counter, 1u);
    }
    return address;
}
