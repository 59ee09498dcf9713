use super::*;

const SIZE: Size = Size {
    width: 2048,
    height: 2048,
};

const NEED: Need = Need {
    what: "build",
    pixel: 60,
    node: 32,
    pixels_max: 65_535 * 64,
};

fn attempts(size: Size, binding: u64) -> Attempts {
    Attempts {
        size,
        need: NEED,
        adapter: "board".into(),
        binding,
        memory: MEMORY,
        bands: vec![Band::whole(size)],
        capacity: 2 * size.width * size.height,
        known: None,
        side: 1,
    }
}

/// Runs a device that has `memory` bytes over rows that need `nodes` each. Gives the
/// bands that were finished, and the most bytes that were asked for.
fn run(attempts: &mut Attempts, nodes: u32, memory: u64) -> Result<(Vec<Band>, u64), GpuError> {
    let (mut done, mut most) = (Vec::new(), 0);
    for _ in 0..100_000 {
        let Some((band, capacity)) = attempts.next() else {
            return Ok((done, most));
        };
        assert!(16 * u64::from(capacity) <= attempts.binding, "bindable");
        let bytes = attempts.bytes(band, capacity);
        most = most.max(bytes);
        let counted = band.rows.saturating_mul(nodes).min(SATURATED);
        if bytes > memory {
            let adapter = "board".into();
            let what = "nodes";
            attempts.failed(
                band,
                capacity,
                GpuError::Memory {
                    adapter,
                    what,
                    bytes,
                },
            )?;
        } else if counted > capacity {
            attempts.overflowed(band, counted)?;
        } else {
            done.push(band);
        }
    }
    panic!("no end of attempts");
}

fn rows(bands: &[Band]) -> u32 {
    let mut next = 0;
    for band in bands {
        assert_eq!(band.first, next, "from top to bottom, without gaps");
        next += band.rows;
    }
    next
}

/// Whatever the device offers, and whatever it counts: no attempt asks for more than
/// [`MEMORY`], though two buffers of the largest binding would take twice that.
#[test]
fn no_attempt_asks_for_more_than_the_budget() {
    for nodes in [0, 1, 5_000, 32_768, 10_000_000, 30_000_000, u32::MAX] {
        let mut attempts = attempts(SIZE, MEMORY);
        let mut most = 0;
        for _ in 0..20_000 {
            let Some((band, capacity)) = attempts.next() else {
                break;
            };
            most = most.max(attempts.bytes(band, capacity));
            let counted = band.rows.saturating_mul(nodes).min(SATURATED);
            if counted > capacity && attempts.overflowed(band, counted).is_err() {
                break;
            }
        }
        assert!(
            most <= MEMORY && most > MEMORY / 4,
            "{most} bytes for {nodes} nodes a row"
        );
    }
}

/// A device with any amount of memory finishes what it can in bands, and refuses by name
/// what a single row is too much of.
#[test]
fn a_device_with_less_memory_gets_bands() {
    let nodes = 40_000;
    let row = 60 * 2048 + 32 * u64::from(nodes);
    for memory in [row, row + 1, 2 * row, 10 * row, 100_000_000] {
        let seen = run(&mut attempts(SIZE, MEMORY), nodes, memory);
        let (done, most) = seen.unwrap_or_else(|e| panic!("{memory} bytes: {e}"));
        assert_eq!(rows(&done), 2048, "{memory} bytes");
        assert!(most > memory, "{memory} bytes: it was felt");
    }
    let error = run(&mut attempts(SIZE, MEMORY), nodes, row - 1).expect_err("a byte too few");
    let GpuError::Limit {
        what,
        needed,
        limit,
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!((what, needed, limit), ("build", 40_000, 39_999));
    // Not even pixels fit: the device's own words.
    let error = run(&mut attempts(SIZE, MEMORY), 0, 60 * 2048 - 1).expect_err("no row fits");
    assert!(
        matches!(error, GpuError::Memory { what: "nodes", .. }),
        "{error}"
    );
}

/// A row with fewer nodes than a first guess has room for is no reason to refuse.
#[test]
fn a_guess_that_is_too_large_is_halved() {
    let size = Size {
        width: 8,
        height: 1,
    };
    let mut attempts = attempts(size, MEMORY);
    attempts.capacity = 1_000_000;
    let (done, _) = run(&mut attempts, 3, 60 * 8 + 32 * 4).expect("three nodes fit");
    assert_eq!(rows(&done), 1);
}

/// Lists that are given are split by rows, each with room for exactly its own.
#[test]
fn known_rows_have_exactly_their_room() {
    let size = Size {
        width: 4,
        height: 4,
    };
    let given = || attempts(size, 16 * 5).with_rows([1, 2, 3, 0].into_iter());
    let seen = given().map(|(band, capacity)| (band.first, band.rows, capacity));
    let seen: Vec<_> = seen.collect();
    assert_eq!(
        seen,
        [(0, 2, 3), (2, 2, 3)],
        "six nodes cannot be bound at once"
    );
    let memory = |_| GpuError::Memory {
        adapter: "board".into(),
        what: "nodes",
        bytes: 1,
    };
    let mut attempts = given();
    let mut failed = 0;
    let error = loop {
        let (band, capacity) = attempts.next().expect("nothing fits");
        failed += 1;
        if let Err(error) = attempts.failed(band, capacity, memory(())) {
            break error;
        }
    };
    assert_eq!((failed, error), (2, memory(())), "two rows, then one");
}

#[test]
fn other_errors_are_passed_on() {
    let mut attempts = attempts(SIZE, MEMORY);
    let (band, capacity) = attempts.next().expect("the first");
    let lost = GpuError::Lost {
        adapter: "board".into(),
        reason: "gone".into(),
    };
    assert_eq!(attempts.failed(band, capacity, lost.clone()), Err(lost));
}
