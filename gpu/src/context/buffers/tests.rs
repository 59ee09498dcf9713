use super::*;
use crate::context::adapters;

fn devices() -> impl Iterator<Item = Gpu> {
    let all = adapters(wgpu::Backends::VULKAN);
    assert!(!all.is_empty(), "no adapter: `./x setup` installs two");
    all.into_iter().map(|a| Gpu::open(&a).expect("a device"))
}

#[test]
fn what_is_uploaded_in_pieces_is_read_back() {
    let words = STAGING / 4;
    for gpu in devices() {
        for count in [0, 1, words - 1, words, 2 * words + 5] {
            let data: Vec<u32> = (0..)
                .map(|i: u32| i.wrapping_mul(2_654_435_761))
                .take(count)
                .collect();
            let buffer = gpu.upload("words", &data).expect("it fits");
            let back: Vec<u32> = gpu.read(&buffer, count).expect("it is there");
            assert!(back == data, "{count} words on {}", gpu.name);
            // Items that do not divide a piece.
            let triples: Vec<[u32; 3]> = gpu.read(&buffer, count / 3).expect("it is there");
            assert!(
                triples.as_flattened() == &data[..count / 3 * 3],
                "{count} words as triples"
            );
        }
    }
}

#[test]
fn what_the_driver_has_no_memory_for_is_named_and_the_device_lives() {
    for gpu in devices() {
        // SwiftShader offers a binding of 1 GiB, and refuses a buffer of that size.
        let bytes = gpu.binding_limit();
        if let Err(error) = gpu.storage("all of it", bytes) {
            let what = "all of it";
            let adapter = gpu.name.clone();
            assert_eq!(
                error,
                GpuError::Memory {
                    adapter,
                    what,
                    bytes
                }
            );
        }
        let small = gpu.upload("small", &[7_u32]).expect("a word fits");
        assert_eq!(
            gpu.read::<u32>(&small, 1).expect("it works"),
            [7],
            "{}",
            gpu.name
        );
    }
}

#[test]
fn restricted_memory_is_an_error_by_name() {
    for mut gpu in devices() {
        gpu.restrict_memory(1000);
        let held = gpu.storage("first", 600).expect("it fits");
        let error = gpu.storage("second", 600).expect_err("both do not fit");
        assert!(
            matches!(
                error,
                GpuError::Memory {
                    what: "second",
                    bytes: 600,
                    ..
                }
            ),
            "{error}"
        );
        drop(held);
        gpu.wait().expect("the device lives");
        gpu.storage("second", 600).expect("there is room again");
    }
}
