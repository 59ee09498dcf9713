//! Every term that the report uses, in a sentence.

use maud::{Markup, html};

use crate::cause::Cause;
use crate::row::Class;

/// Terms beside classes and causes.
const TERMS: [(&str, &str); 21] = [
    (
        "scene",
        "A folder of the corpus: meshes, materials, a camera, and what it is there to show.",
    ),
    (
        "leg",
        "One of the independent implementations that a scene goes through: spec, gpu (on each \
             adapter, by each path) and embree.",
    ),
    (
        "spec",
        "The meaning: scalar code that decides in integers. Whatever differs from it differs \
              from what the papers say.",
    ),
    (
        "embree",
        "Intel's ray tracer, asked for every hit along a ray through every sample. A vote, \
                not the truth: near edges it is itself inexact.",
    ),
    (
        "path",
        "How the GPU covers pixels: fragment is its own rasteriser, compute is ours.",
    ),
    (
        "stage",
        "A step of the algorithm. Each is compared from equal inputs, so that a difference \
               belongs to the first stage that shows it.",
    ),
    ("pair", "Two legs that are compared."),
    (
        "item",
        "What a stage is compared by: a corner, a fragment, a pixel, a (ray, triangle) pair.",
    ),
    (
        "fragment",
        "A pixel of a triangle: pixel, triangle, depth key, covered samples.",
    ),
    (
        "depth key",
        "Depth at a sample as a 31-bit integer; the same on every leg, bit for bit.",
    ),
    (
        "depth complexity",
        "How many fragments a pixel's list holds.",
    ),
    (
        "reflective shadow map",
        "What the lamp sees, texel by texel; each texel that sees something is a small light.",
    ),
    (
        "buffer A, buffer B",
        "Light of one bounce as if nothing were in its way, and the part of it that blockers \
         keep away; B has fewer pixels and is blurred. Indirect light is A - B.",
    ),
    (
        "reference",
        "Of indirect light: the same picture without noise, in which every pixel traces its own \
         rays to its whole kernel and Embree says what is blocked.",
    ),
    (
        "RMSE",
        "Root of the mean square of the difference of two pictures, over all channels of all \
         pixels, in linear colour.",
    ),
    (
        "edge",
        "The share of items too close to an edge for Embree's own precision. Decided before \
              any result is looked at; counted, not judged, and held to a budget.",
    ),
    (
        "not judged",
        "Counted but admitted either way: items in class edge, pixels that a coarser \
                    grid MAY cover, decisions whose threshold lies inside the bound.",
    ),
    (
        "error / bound",
        "The largest error, as a share of what the spec allows; above 1 it differs.",
    ),
    (
        "plan",
        "What the scene needs. The rest is skipped, and the reason given.",
    ),
    (
        "skipped",
        "Nothing was compared, for the reason given. Never counted as agreement.",
    ),
    (
        "cached",
        "Taken from an earlier run with the same scene, code, options and driver.",
    ),
];

/// All classes, in order.
const CLASSES: [Class; 7] = [
    Class::Exact,
    Class::Structure,
    Class::Tie,
    Class::Interval,
    Class::Decision,
    Class::Band,
    Class::Vote,
];

/// The name of a class as JSON has it.
pub fn class_name(class: Class) -> &'static str {
    match class {
        Class::Exact => "exact",
        Class::Structure => "structure",
        Class::Tie => "tie",
        Class::Interval => "interval",
        Class::Decision => "decision",
        Class::Band => "band",
        Class::Vote => "vote",
    }
}

fn class_meaning(class: Class) -> &'static str {
    match class {
        Class::Exact => "Equal, bit for bit.",
        Class::Structure => {
            "Lists are sound (each node in exactly one list, no cycles, counters right), then \
             equal as multisets."
        }
        Class::Tie => "Sorted by depth key; equal keys by triangle, instance and mask.",
        Class::Interval => {
            "Within the spec's own bound on what 32-bit arithmetic may return, never a tuned \
             tolerance."
        }
        Class::Decision => {
            "Decided by a computed number; where its bound reaches over the threshold, both \
             outcomes are admitted and counted."
        }
        Class::Band => "What a grid that is one sub-pixel off must, may and must not cover.",
        Class::Vote => {
            "Agreement with a reference that is inexact near edges; those are not judged."
        }
    }
}

fn cause_meaning(cause: Cause) -> &'static str {
    match cause {
        Cause::Vertex => {
            "A position or a corner lies outside the bound of transform, clip or snap, or \
             neighbours do not meet."
        }
        Cause::Coverage => "A triangle covers a sample that it must not, or misses one it must.",
        Cause::Duplicate => "A fragment is in a list more than once.",
        Cause::LostNode => "An address was handed out, but no list leads to its node.",
        Cause::CorruptLink => "A link leads outside the nodes, or into another pixel's list.",
        Cause::Cycle => "A list leads back into itself.",
        Cause::Overflow => "Counter, capacity and stored nodes do not agree.",
        Cause::DepthKey => "The fragment is right, its depth key is not.",
        Cause::SortOrder => "Neighbours with different depth keys stand in the wrong order.",
        Cause::TieOrder => "Neighbours with equal depth keys stand in the wrong order.",
        Cause::Interval => "A value lies outside its bound.",
        Cause::BlendRounding => "A colour lies outside its bound although its list is right.",
        Cause::SampleMask => "The fragment is right, its sample mask is not.",
        Cause::StalePass => {
            "Something of an earlier pass or frame shows through, or a pass reads what it writes \
             itself."
        }
        Cause::Edge => "Closer to an edge than the reference's own precision; not judged.",
        Cause::ReferenceMissing => "There was nothing to compare with.",
        Cause::DeviceLost => "The device went away.",
        Cause::OracleDisagreement => {
            "Two legs agree against the third: Embree and the GPU against the spec, or Embree \
             stands alone."
        }
    }
}

/// The section.
pub fn section() -> Markup {
    html! {
        section aria-labelledby="glossary" {
            h2 #glossary { "Glossary" }
            dl.glossary { @for (term, meaning) in TERMS {
                dt id={"term-" (term.replace(' ', "-"))} { (term) } dd { (meaning) }
            } }
            h3 { "Classes: what may differ" }
            dl.glossary { @for class in CLASSES {
                dt id={"class-" (class_name(class))} { (class_name(class)) }
                dd { (class_meaning(class)) }
            } }
            h3 { "Causes: why something differs" }
            dl.glossary { @for cause in Cause::ALL {
                dt id={"cause-" (cause.name())} { (cause.name()) } dd { (cause_meaning(cause)) }
            } }
        }
    }
}
