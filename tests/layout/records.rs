//! Structs that are written down twice.

use std::mem::{offset_of, size_of};

use naga::{Module, TypeInner};
use triptych_gpu::abuffer::PROGRESS;
use triptych_gpu::abuffer::rivals::Reducing;
use triptych_gpu::dispatch::{Carried, Facet, Lamp, Plane, Task};
use triptych_gpu::frame::Frame;
use triptych_gpu::grid::Cells;
use triptych_gpu::layouts::Listing;
use triptych_gpu::ldm::Told;
use triptych_gpu::rsm::{Parameters, View};
use triptych_gpu::tiles::{List, Region, Tiled};

use super::everywhere;

/// Fields with their offsets, and the size in bytes.
type Layout = (Vec<(String, u32)>, u32);

fn layout(module: &Module, name: &str) -> Option<Layout> {
    let (_, ty) = module
        .types
        .iter()
        .find(|(_, t)| t.name.as_deref() == Some(name))?;
    let TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name} is no struct");
    };
    let field = |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset);
    Some((members.iter().map(field).collect(), *span))
}

/// A struct of 32-bit words.
fn words(names: &[&str]) -> Layout {
    let fields: Vec<(String, u32)> = (0..)
        .step_by(4)
        .zip(names)
        .map(|(at, n)| (n.to_string(), at))
        .collect();
    let size = 4 * u32::try_from(names.len()).expect("few");
    (fields, size)
}

fn named(fields: &[(&str, u32)]) -> Vec<(String, u32)> {
    let field = |(name, at): &(&str, u32)| ((*name).to_owned(), *at);
    fields.iter().map(field).collect()
}

#[test]
fn the_frame_is_that_of_rust() {
    macro_rules! fields {
        ($($field:ident)*) => {
            vec![$((stringify!($field).to_owned(), offset_of!(Frame, $field))),*]
        };
    }
    let fields = fields!(
        width height bits capacity first_row rows work_first work_count items guard_x guard_y
        depth_test background samples sample order once places
    );
    let word = |at: usize| u32::try_from(at).expect("a small struct");
    let fields = fields
        .into_iter()
        .map(|(name, at)| (name, word(at)))
        .collect();
    everywhere("Frame", &(fields, word(size_of::<Frame>())), layout);
    let names = [
        "x", "y", "z", "overlap", "items", "chunks", "capacity", "run", "any",
    ];
    let (mut cells, _) = words(&names);
    cells.push(("unused".to_owned(), 48));
    assert_eq!(size_of::<Cells>(), 64, "a block of 16 words");
    everywhere("Cells", &(cells, 64), layout);
}

macro_rules! layout_of {
    ($of:ty: $($field:ident)*) => {{
        let fields = [$((stringify!($field), offset_of!($of, $field))),*];
        let word = |at: usize| u32::try_from(at).expect("a small struct");
        let fields = fields.map(|(name, at)| (name, word(at)));
        (named(&fields), word(size_of::<$of>()))
    }};
}

#[test]
fn what_is_told_of_maps_is_that_of_rust() {
    let told = layout_of!(Told: bits shift half half_shift first_map maps first_pixel pixels triangles
        items first_row rows capacity run most power low_x low_y low_z small larges);
    everywhere("Told", &told, layout);
    let map = [
        ("columns", 0),
        ("width", 12),
        ("rows", 16),
        ("height", 28),
        ("depths", 32),
        ("first", 44),
        ("across", 48),
        ("left", 60),
        ("down", 64),
        ("top", 76),
        ("towards", 80),
        ("nearest", 92),
        ("about_columns", 96),
        ("about_left", 108),
        ("about_rows", 112),
        ("about_top", 124),
    ];
    everywhere("Map", &(named(&map), 128), layout);
    let receiver = [("point", 0), ("off", 12), ("normal", 16), ("unused", 28)];
    everywhere("Receiver", &(named(&receiver), 32), layout);
    everywhere("Hits", &words(&["key", "before", "behind"]), layout);
    everywhere("Open", &words(&["whole", "part"]), layout);
    everywhere("Link", &words(&["key", "next"]), layout);
    let tiled = layout_of!(Tiled: items capacity first count run groups layers stored);
    everywhere("Tiled", &tiled, layout);
    let listing = layout_of!(Listing: entries regions items run first flags from_key from_face
        until_key until_face links layers sample samples);
    everywhere("Listing", &listing, layout);
    let reducing = layout_of!(Reducing: halvings across down falloff);
    everywhere("Reduction", &reducing, layout);
    everywhere(
        "PackedNode",
        &words(&["colour", "key", "face", "link"]),
        layout,
    );
    let list = layout_of!(List: start length filled);
    everywhere("List", &list, layout);
    let region = layout_of!(Region: first capacity attempts unused in_order);
    everywhere("Region", &region, layout);
    everywhere("Digest", &words(&["count", "words"]), layout);
}

#[test]
fn the_frame_of_indirect_light_is_that_of_rust() {
    let parameters = layout_of!(Parameters: width height map_width map_height coarse_width
        coarse_height radius stride divisor blur offset bias clamp edge items first rows reference
        unused strength background);
    everywhere("Parameters", &parameters, layout);
    let (view, size) = layout_of!(View: rows viewpoint near width height unused);
    let rows = [("x", 0), ("y", 16), ("z", 32), ("w", 48)];
    let view = named(&rows).into_iter().chain(view.into_iter().skip(1));
    everywhere("View", &(view.collect(), size), layout);
}

#[test]
fn what_is_told_of_rays_is_that_of_rust() {
    let task = layout_of!(Task: items first capacity lamps depth width unused background origin
        direction);
    everywhere("Task", &task, layout);
    everywhere("Plane", &layout_of!(Plane: corner right down), layout);
    let facet = layout_of!(Facet: a axis b c unit coarse colour mirror);
    everywhere("Facet", &facet, layout);
    everywhere("Carried", &layout_of!(Carried: parts whose), layout);
    let lamp = layout_of!(Lamp: position reference strength least);
    everywhere("Lamp", &lamp, layout);
}

#[test]
fn records_are_the_words_that_the_host_reads() {
    everywhere("Node", &words(&["key", "next", "prim", "mask"]), layout);
    everywhere(
        "Fragment",
        &words(&["pixel", "prim", "key", "mask"]),
        layout,
    );
    everywhere("Entry", &words(&["prim", "next"]), layout);
    everywhere("Hit", &words(&["prim", "time", "state", "at"]), layout);
    let ray = [
        ("origin", 0),
        ("segment", 12),
        ("direction", 16),
        ("owner", 28),
    ];
    everywhere("Ray", &(named(&ray), 32), layout);
    let surface = [("point", 0), ("face", 12)];
    everywhere("Surface", &(named(&surface), 16), layout);
    let light = [("point", 0), ("face", 12), ("unit", 16), ("unused", 28)];
    everywhere("Light", &(named(&light), 32), layout);
    let place = [("texel", 0), ("key", 8), ("known", 12)];
    everywhere("Place", &(named(&place), 16), layout);
    let face = [
        ("unit", 0),
        ("axis", 12),
        ("coarse", 16),
        ("unused", 28),
        ("colour", 32),
    ];
    everywhere("Face", &(named(&face), 48), layout);
    everywhere("Vertex", &words(&["x", "y", "z", "instance"]), layout);
    let size = |module: &Module, name: &str| Some(u64::from(layout(module, name)?.1));
    everywhere("Progress", &PROGRESS, size);
}
