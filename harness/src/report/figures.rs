//! Pictures side by side, each with what its colours mean.

use maud::{Markup, html};

use super::{Picture, SceneReport, base64, text, worst};
use crate::digest::leg_parts;
use crate::picture::{Image, Legend, Mark, heat, swatch};
use crate::text::{clean, count, plural};

/// A small picture is enlarged by the largest whole factor up to this width.
const WIDTH: u32 = 320;

/// Largest enlargement: a single pixel need not fill the window.
const ENLARGE_MAX: u32 = 32;

/// Boxes in the legend of a heat map, at most.
const STEPS: u32 = 10;

/// The pictures of a scene: spec, a GPU leg and Embree, then the maps and other legs; frame by
/// frame, where there are several.
pub fn grid(scene: &SceneReport) -> Markup {
    let groups = groups(scene);
    let frame = |group: &Vec<&Picture>| frame_of(&group[0].title).1;
    let frames: Vec<_> = groups.chunk_by(|a, b| frame(a) == frame(b)).collect();
    html! {
        @if !frames.is_empty() { h4 { "Pictures" } }
        @for groups in &frames {
            @let (three, more) = groups.split_at(groups.len().min(3));
            @if frames.len() > 1 { h5 { "Frame " (frame(&groups[0])) } }
            div class="figures three" { @for group in three { (figure(&scene.name, group)) } }
            div.figures { @for group in more { (figure(&scene.name, group)) } }
        }
    }
}

/// Pictures of GPU legs that are the same, byte for byte, together. Frame by frame, the three
/// legs come first, with the GPU leg to look at first; then causes, layers, light and its
/// shadows, differences, and the other GPU legs.
fn groups(scene: &SceneReport) -> Vec<Vec<&Picture>> {
    let kind = |picture: &Picture| leg_parts(frame_of(&picture.title).0).0.to_owned();
    let frame = |picture: &Picture| frame_of(&picture.title).1;
    let by_gpus = |picture: &Picture| kind(picture).ends_with("gpu");
    let mut groups: Vec<Vec<&Picture>> = Vec::new();
    for picture in &scene.pictures {
        let same = |group: &&mut Vec<&Picture>| {
            let first = group[0];
            let alike = (kind(first), frame(first)) == (kind(picture), frame(picture));
            by_gpus(first) && alike && first.image == picture.image
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(picture),
            None => groups.push(vec![picture]),
        }
    }
    let diverging = worst::first(&scene.rows).map(|row| row.b.as_str());
    let first_in = |number: u32| {
        let of_frame = |group: &Vec<&Picture>| frame(group[0]) == number;
        let shows = |group: &Vec<&Picture>| {
            let mut titles = group.iter().map(|p| frame_of(&p.title).0);
            of_frame(group) && titles.any(|title| Some(title) == diverging)
        };
        let is_leg = |group: &Vec<&Picture>| of_frame(group) && kind(group[0]) == "gpu";
        let first = groups.iter().position(shows);
        first.or_else(|| groups.iter().position(is_leg))
    };
    let rank = |(i, group): (usize, &Vec<&Picture>)| {
        let frame = frame(group[0]);
        let rank = match kind(group[0]).as_str() {
            "spec" => 0,
            "gpu" if Some(i) == first_in(frame) => 1,
            "embree" => 2,
            "causes" => 3,
            "layers" => 4,
            "without indirect shadows" => 5,
            "indirect shadows" => 6,
            "reference" => 7,
            "difference of gpu" => 8,
            "difference of embree" => 9,
            _ => 10,
        };
        (frame, rank)
    };
    let ranks: Vec<(u32, u32)> = groups.iter().enumerate().map(rank).collect();
    let mut ranked: Vec<_> = ranks.into_iter().zip(groups).collect();
    ranked.sort_by_key(|(rank, _)| *rank);
    ranked.into_iter().map(|(_, group)| group).collect()
}

/// A title without the number of its frame, and that number; the first is not written.
fn frame_of(title: &str) -> (&str, u32) {
    let numbered = title.rsplit_once(" frame ");
    let frame = numbered.and_then(|(rest, number)| Some((rest, number.parse().ok()?)));
    frame.unwrap_or((title, 1))
}

fn figure(scene: &str, group: &[&Picture]) -> Markup {
    let Picture { caption, image, .. } = group[0];
    let titles: Vec<_> = group.iter().map(|p| clean(&p.title)).collect();
    let alt = format!("{} of {}: {}", titles[0], clean(scene), clean(caption));
    html! {
        figure data-titles=(titles.join("\n")) {
            div.shot { (img(image, &alt)) }
            figcaption {
                @for (i, title) in titles.iter().enumerate() {
                    @if i > 0 { ", " }
                    strong { (title) }
                }
                @if group.len() > 1 { " (the same, byte for byte)" }
                @if !caption.is_empty() { ". " (text(caption)) }
                " " span.note { (text(&image.note)) }
                (legend(&image.legend))
            }
        }
    }
}

fn img(image: &Image, alt: &str) -> Markup {
    let side = image.width.max(image.height).max(1);
    let enlarge = (WIDTH / side).clamp(1, ENLARGE_MAX);
    html! {
        img class=[(enlarge > 1).then_some("pixels")] src=(base64::png(&image.png)) alt=(alt)
            width=(image.width * enlarge) height=(image.height * enlarge);
    }
}

fn legend(legend: &Legend) -> Markup {
    match legend {
        Legend::Colours => html! {},
        Legend::Heat { max } => html! {
            ol.heat aria-label="Colours from 0 to the largest count" {
                @for n in steps(*max) {
                    @let [r, g, b] = heat(n, *max);
                    li { span style={"background:rgb(" (r) "," (g) "," (b) ")"} {}
                        (count(u64::from(n))) }
                }
            }
        },
        Legend::Causes(marks) if marks.is_empty() => html! { p { "No pixel differs." } },
        Legend::Causes(marks) => html! { ul.causes { @for mark in marks { (cause(mark)) } } },
    }
}

fn cause(mark: &Mark) -> Markup {
    let sample = base64::png(&swatch(mark.cause));
    let [x, y] = mark.first;
    html! {
        li {
            img.pixels src=(sample) alt="" width="16" height="16";
            " "
            @match mark.cause {
                Some(cause) => { a href={"#cause-" (cause.name())} { (cause.name()) } }
                None => { strong { "without a cause" } }
            }
            ": " (plural(mark.pixels, "pixel")) ", first at column " (x) ", row " (y)
        }
    }
}

/// 0, powers of two, and the largest count.
fn steps(max: u32) -> Vec<u32> {
    let doublings = max.checked_ilog2().map_or(0, |n| n + 1);
    let stride = doublings.div_ceil(STEPS - 2).max(1) as usize;
    let powers = (0..doublings).step_by(stride).map(|n| 1 << n);
    let mut steps: Vec<u32> = std::iter::once(0).chain(powers).collect();
    if max > 0 && steps.last() != Some(&max) {
        steps.push(max);
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture;
    use triptych_spec::scene::Size;

    #[test]
    fn the_legend_spans_the_scale_and_stays_short() {
        assert_eq!(steps(0), [0]);
        assert_eq!(steps(1), [0, 1]);
        assert_eq!(steps(5), [0, 1, 2, 4, 5]);
        assert_eq!(steps(300), [0, 1, 4, 16, 64, 256, 300]);
        for max in [1, 255, 256, 65_535, u32::MAX] {
            let steps = steps(max);
            assert!(steps.len() <= STEPS as usize, "{max}: {steps:?}");
            assert_eq!(steps.last(), Some(&max));
            assert!(steps.is_sorted_by(|a, b| a < b), "{steps:?}");
        }
    }

    fn picture(title: &str) -> Picture {
        let size = Size {
            width: 1,
            height: 1,
        };
        Picture {
            title: title.to_owned(),
            caption: String::new(),
            image: picture::linear(size, &[[0.0; 3]]),
        }
    }

    #[test]
    fn frames_stay_together_and_begin_with_the_legs() {
        let titles = [
            "spec",
            "without indirect shadows",
            "spec frame 2",
            "without indirect shadows frame 2",
            "embree",
            "embree frame 2",
            "gpu@a/compute",
            "gpu@a/compute frame 2",
            "gpu@b/compute",
            "gpu@b/compute frame 2",
        ];
        let scene = SceneReport {
            pictures: titles.map(picture).to_vec(),
            ..SceneReport::default()
        };
        let groups: Vec<Vec<String>> = groups(&scene)
            .into_iter()
            .map(|group| group.iter().map(|p| p.title.clone()).collect())
            .collect();
        // The same picture of two GPU legs is one figure.
        let expected: [&[&str]; 8] = [
            &["spec"],
            &["gpu@a/compute", "gpu@b/compute"],
            &["embree"],
            &["without indirect shadows"],
            &["spec frame 2"],
            &["gpu@a/compute frame 2", "gpu@b/compute frame 2"],
            &["embree frame 2"],
            &["without indirect shadows frame 2"],
        ];
        assert_eq!(groups, expected);
        let page = grid(&scene).into_string();
        assert!(page.contains("Frame 1") && page.contains("Frame 2"));
    }
}
