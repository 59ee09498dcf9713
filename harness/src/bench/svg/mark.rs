//! Points of the front, each leg's in a shape of its own.

use maud::{Markup, html};

/// A point of a style at a place.
pub(super) fn mark(style: usize, [x, y]: [f64; 2]) -> Markup {
    let class = format!("mark s{style}");
    let corners: &[[f64; 2]] = match style {
        0 => {
            return html! { circle class=(class) cx=(format!("{x:.1}")) cy=(format!("{y:.1}")) r="4" {} };
        }
        1 => &[[-3.5, -3.5], [3.5, -3.5], [3.5, 3.5], [-3.5, 3.5]],
        2 => &[[0.0, -5.0], [5.0, 0.0], [0.0, 5.0], [-5.0, 0.0]],
        3 => &[[0.0, -4.8], [4.6, 3.4], [-4.6, 3.4]],
        4 => &[[0.0, 4.8], [4.6, -3.4], [-4.6, -3.4]],
        5 => &[[-4.8, 0.0], [3.4, 4.6], [3.4, -4.6]],
        6 => &[[4.8, 0.0], [-3.4, 4.6], [-3.4, -4.6]],
        _ => &[[-2.0, -5.0], [2.0, -5.0], [2.0, 5.0], [-2.0, 5.0]],
    };
    let corner = |[dx, dy]: &[f64; 2]| format!("{:.1},{:.1}", x + dx, y + dy);
    let points: Vec<String> = corners.iter().map(corner).collect();
    html! { polygon class=(class) points=(points.join(" ")) {} }
}
