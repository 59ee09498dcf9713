use triptych_gpu::context::{Gpu, adapters};
use triptych_gpu::kernel::Kernels;
use triptych_gpu::vertex::run;
use triptych_gpu::wgsl::Sources;

use super::*;

fn devices() -> Vec<Gpu> {
    let all = adapters(wgpu::Backends::VULKAN);
    all.iter()
        .map(|a| Gpu::open(a).expect("a device"))
        .collect()
}
#[test]
fn measure() {
    for gpu in devices() {
        let kernels = Kernels::new(Sources::shipped(false));
        for e in crate::corpus::list(&crate::corpus::root()).unwrap() {
            let Ok(l) = crate::scene::load_entry(&e, None) else {
                println!("{} no", e.name);
                continue;
            };
            let t0 = std::time::Instant::now();
            let run = run(&gpu, &kernels, &l.scene, 8).unwrap();
            let t1 = t0.elapsed();
            let tr = compare_transform(&l.scene, &run.positions);
            let t0 = std::time::Instant::now();
            let r = compare(&l.scene, 8, &run.primitives);
            let t2 = t0.elapsed();
            println!(
                "{} {} {} tris run {:?} {:?} cmp {:?}\n   {} agrees {} differing {} {:?}",
                gpu.name,
                e.name,
                r.triangles,
                t1,
                run.times,
                t2,
                r,
                r.agrees(),
                r.differing,
                r.told.first().map(|d| d.to_string())
            );
            println!(
                "   transform outside {} unbounded {} e/b {:.4} {:?}",
                tr.outside,
                tr.unbounded,
                tr.error_over_bound,
                tr.told.first()
            );
        }
    }
}
