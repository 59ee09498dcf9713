//! Looking into a scene: two pictures with a slider, and the lists of a pixel. Shown by
//! the script, which it needs; the lists of the worst pixel of each leg are text.

use maud::{Markup, html};

use super::scene::differences;
use super::{Difference, SceneReport, base64, text};
use crate::sheet::Sheet;
use crate::text::{clean, count, plural};

/// The viewer of a scene that has pictures.
pub fn viewer(scene: &SceneReport) -> Markup {
    let Some(size) = scene.size.filter(|_| !scene.pictures.is_empty()) else {
        return html! {};
    };
    let lists = !scene.sheets.is_empty();
    html! {
        section.viewer hidden aria-label={"Pixels of " (clean(&scene.name))}
            data-width=(size.width) data-height=(size.height) {
            h4 { @if lists { "Compare, and look into pixels" } @else { "Compare" } }
            div.tools {
                label { "Left " select.left {} }
                label { "Right " select.right {} }
                button.swap type="button" { "Swap" }
                span { button.out type="button" aria-label="Smaller" { "−" }
                    output.factor { "1×" } button.in type="button" aria-label="Larger" { "+" } }
                label { "Column " input.column type="number" min="0" max=(size.width - 1) value="0"; }
                label { "Row " input.row type="number" min="0" max=(size.height - 1) value="0"; }
                button.look type="button" hidden[!lists] { "Show lists" }
            }
            div.both {
                div.room {
                    div.stage tabindex="0" role="group"
                        aria-label="Pictures: arrow keys move the cursor, Enter shows the lists" {
                        div.canvas { img.under alt=""; img.over alt=""; span.divider {} span.cursor {} }
                    }
                    input.split type="range" min="0" max="1000" value="500"
                        aria-label="How much of the left picture is shown";
                    p.here aria-live="polite" {}
                }
                div.lists.scroll hidden[!lists] tabindex="0" role="region" aria-label="Lists of the pixel" {
                    p.soft { "Click on a pixel of any picture: its three lists appear here." }
                }
            }
            @for (i, sheet) in scene.sheets.iter().enumerate() { (template(sheet, &scene.sheets[..i])) }
        }
    }
}

/// The lists, for the script. A template is neither shown nor run. Legs that differ alike
/// have their lists in the first one's.
fn template(sheet: &Sheet, before: &[Sheet]) -> Markup {
    let like = before.iter().position(|other| other.data == sheet.data);
    html! {
        template.sheet data-leg=(clean(&sheet.leg)) data-against=(clean(&sheet.against))
            data-bits=(sheet.bits) data-stride=(sheet.stride) data-left-out=(sheet.left_out)
            data-note=(clean(&sheet.note)) data-like=[like] {
            @if like.is_none() { (base64::encode(&sheet.data)) }
        }
    }
}

/// What the file holds of the lists, and what not; and the worst pixels' in words.
pub fn held(scene: &SceneReport) -> Markup {
    let worst = scene.sheets.iter().filter_map(|s| s.worst.clone());
    let worst: Vec<Difference> = worst.collect();
    html! {
        @if !worst.is_empty() {
            details.words {
                summary { "The worst pixel of each GPU leg, as text" }
                (differences(&worst))
            }
        }
        @let thinned: Vec<&Sheet> = scene.sheets.iter().filter(|s| s.left_out > 0).collect();
        @if !thinned.is_empty() || !scene.left_out.is_empty() {
            ul.left-out {
                @for sheet in thinned { li { (line(sheet)) } }
                @for what in &scene.left_out { li { (text(what)) } }
            }
        }
    }
}

fn line(sheet: &Sheet) -> Markup {
    let (held, left_out) = (count(sheet.held), plural(sheet.left_out, "pixel"));
    html! {
        (text(&sheet.leg)) @if !sheet.is_gpu() { " on a grid of 1/" (1_u64 << sheet.bits.min(63)) }
        @if sheet.is_gpu() {
            ": lists of " (held) " pixels that differ are in this file, the worst; " (left_out)
            " that differ are left out to keep it small."
        } @else {
            ": lists of " (held) " pixels are in this file, of each " (sheet.stride)
            "th column and row; " (left_out) " left out to keep it small."
        }
        " " code { "--dump" } " writes all."
    }
}
