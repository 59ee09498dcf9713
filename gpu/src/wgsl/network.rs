//! WGSL that is written by a program: sorting networks on scalars.
//!
//! An invocation's array that is indexed by a variable lies in memory; a variable for each entry
//! lies in a register. So there is a function for each size, with every comparison written out:
//! Batcher's odd-even merge sort (1968), 19, 63, 191 and 543 comparisons for 8, 16, 32 and 64
//! entries.

use std::fmt::Write;

/// Entries that the networks sort.
pub const SIZES: [u32; 4] = [8, 16, 32, 64];

/// The files `network` and, where pixels have several samples, `network_samples`: for each size a kernel
/// that sorts and blends lists of at most as many. What is seen of several samples leaves entries no
/// registers: these are written back and read again, one after another.
pub(super) fn text(has_samples: bool) -> String {
    let mut text = String::from("// Lists of a few entries, sorted in registers and blended.\n");
    for (number, size) in SIZES.into_iter().enumerate() {
        let written =
            shaded(&mut text, size, has_samples).and_then(|()| entry(&mut text, number, size));
        written.expect("a string takes all that is written");
    }
    text
}

/// A kernel of stage shade, which has this number in `kernel_of`.
fn entry(text: &mut String, number: usize, size: u32) -> std::fmt::Result {
    write!(
        text,
        "
@compute @workgroup_size(WORKGROUP)
fn shade_{size}(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {{
    let own = pixel_at(chunk_of(group, groups), lane);
    if own.pixel != NOWHERE && kernel_of_run(own.run) == {number}u {{
        show(own.pixel, shaded_{size}(own));
    }}
}}
"
    )
}

/// Reads a list, puts it in order, writes it back if that is asked for, and blends what is not hidden.
fn shaded(text: &mut String, size: u32, has_samples: bool) -> std::fmt::Result {
    writeln!(
        text,
        "\nfn shaded_{size}(own: Own) -> Seen {{\n    let run = own.run;"
    )?;
    for i in 0..size {
        writeln!(text, "    var e{i} = LAST;")?;
    }
    for i in 0..size {
        let read = format!("e{i} = listed[slot(run, {i}u)]");
        writeln!(text, "    if {i}u < run.length {{\n        {read};\n    }}")?;
    }
    for (a, b) in comparisons(size) {
        exchange(text, a, b)?;
    }
    if has_samples {
        write_back(text, size)?;
        return writeln!(text, "    return shaded(own);\n}}");
    }
    writeln!(text, "    if tiled.stored != 0u {{")?;
    write_back(text, size)?;
    writeln!(text, "    }}\n    var seen = unseen();")?;
    for i in 0..size {
        writeln!(
            text,
            "    if !is_hidden(e{i}.x, own.behind) && {i}u < tiled.layers {{\n        \
            seen = over(seen, e{i}, own.behind);"
        )?;
    }
    writeln!(text, "    {}", "}".repeat(size as usize))?;
    writeln!(text, "    return seen;\n}}")
}

/// The entries back to their list.
fn write_back(text: &mut String, size: u32) -> std::fmt::Result {
    for i in 0..size {
        let write = format!("listed[slot(run, {i}u)] = e{i}");
        writeln!(
            text,
            "    if {i}u < run.length {{\n        {write};\n    }}"
        )?;
    }
    Ok(())
}

/// The smaller of two entries to the first, without a branch.
fn exchange(text: &mut String, a: u32, b: u32) -> std::fmt::Result {
    writeln!(
        text,
        "    {{\n        let swaps = less(e{b}, e{a});\n        let e = e{a};"
    )?;
    writeln!(text, "        e{a} = select(e, e{b}, swaps);")?;
    writeln!(text, "        e{b} = select(e{b}, e, swaps);\n    }}")
}

/// Pairs of places in the order in which they are compared: the smaller goes to the first.
fn comparisons(size: u32) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    let mut run = 1;
    while run < size {
        let mut reach = run;
        while reach > 0 {
            for first in (reach % run..size - reach).step_by(2 * reach as usize) {
                for a in first..(first + reach).min(size - reach) {
                    let b = a + reach;
                    if a / (2 * run) == b / (2 * run) {
                        pairs.push((a, b));
                    }
                }
            }
            reach /= 2;
        }
        run *= 2;
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Zeros and ones, as bits of the first entry on, put in order.
    fn sorts(pairs: &[(u32, u32)], mut bits: u64, size: u32) -> bool {
        let ones = bits.count_ones();
        for (a, b) in pairs {
            if bits >> a & 1 > bits >> b & 1 {
                bits ^= 1 << a | 1 << b;
            }
        }
        u128::from(bits) == ((1_u128 << ones) - 1) << (size - ones)
    }

    /// A network sorts all if it sorts zeros and ones (Knuth, The Art of Computer Programming 3,
    /// section 5.3.4, theorem Z).
    #[test]
    fn networks_sort() {
        for size in [8, 16] {
            let pairs = comparisons(size);
            assert!(
                (0..1 << size).all(|bits| sorts(&pairs, bits, size)),
                "{size}"
            );
        }
    }

    /// Of more entries, the halves are sorted as by the network of their size, and then merged, whatever
    /// zeros and ones are in each.
    #[test]
    fn networks_merge_sorted_halves() {
        for size in [16, 32, 64] {
            let half = size / 2;
            let (pairs, of_half) = (comparisons(size), comparisons(half));
            let (halves, merge) = pairs.split_at(2 * of_half.len());
            for first in [0, half] {
                let own = halves.iter().filter(|(a, _)| a / half == first / half);
                let own: Vec<(u32, u32)> = own.map(|(a, b)| (a - first, b - first)).collect();
                assert_eq!(own, of_half, "{size}, from {first}");
            }
            let ones = |n: u32| ((1_u64 << n) - 1) << (half - n);
            for (low, high) in (0..=half).flat_map(|low| (0..=half).map(move |high| (low, high))) {
                let bits = ones(low) | ones(high) << half;
                assert!(sorts(merge, bits, size), "{size}: {low}, {high} ones");
            }
        }
        assert_eq!(
            SIZES.map(|size| comparisons(size).len()),
            [19, 63, 191, 543]
        );
    }
}
