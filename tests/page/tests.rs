//! What a reader does with the report.

use serde_json::json;

use crate::Test;
use crate::browser::Browser;
use crate::place::Place;

/// All tests by name.
pub const ALL: [(&str, Test); 8] = [
    ("a-worst-pixel-shows-its-three-lists", worst),
    ("a-click-on-a-picture-chooses-its-pixel", picture),
    ("keys-move-the-cursor-and-open-lists", keys),
    ("the-slider-is-dragged", slider),
    ("the-index-is-filtered", index),
    ("nothing-is-wider-than-a-phone", phone),
    ("the-page-is-complete-without-scripts", plain),
    ("text-from-outside-stays-text", hostile),
];

const WIDE: [u32; 2] = [1400, 1000];
const PHONE: [u32; 2] = [390, 844];

/// The scene that diverges, which is the first.
const SCENE: &str = "details.scene";

/// Whether the lists of a pixel are shown. They are unpacked first, which takes a while.
fn lists_of([x, y]: [i64; 2]) -> String {
    format!("document.querySelector('.threes caption')?.innerText.includes('column {x}, row {y}:')")
}

/// The pixel that the cursor is on.
fn cursor(browser: &mut Browser) -> [i64; 2] {
    ["column", "row"].map(|axis| {
        let input = format!("document.querySelector('{SCENE} .{axis}').valueAsNumber");
        browser.value(&input).as_i64().expect("a number")
    })
}

fn worst(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    browser.click(&format!("{SCENE} button.pixel"));
    browser.wait("document.querySelector('.threes tbody tr')");
    let heads = browser.value("[...document.querySelectorAll('.threes thead th')].length");
    assert_eq!(heads, 4, "a number and three lists");
    let rows = browser.value("document.querySelectorAll('.threes tbody tr').length");
    assert_eq!(rows, 9, "nine quads");
    let cells = browser
        .value("[...document.querySelectorAll('.threes tr.bad.first td')].map((c) => c.innerText)");
    let cell = |i: usize| cells[i].as_str().unwrap_or_default();
    let prim = cell(0)
        .lines()
        .find(|l| l.starts_with("prim "))
        .unwrap_or_default();
    assert!(!prim.is_empty(), "the spec has the entry: {cells}");
    assert!(cell(1).contains("missing"), "the GPU leg lacks it: {cells}");
    assert!(cell(2).contains(prim), "Embree has it: {cells}");
    let marked = browser.value("document.querySelectorAll('.threes tr.bad').length");
    assert_eq!(marked, 1, "eight of nine agree");
    let others = browser.value("document.querySelectorAll('.threes td.wrong').length");
    assert_eq!(others, 1, "no cell that agrees is marked");
    let mark = browser.value("document.querySelector('.threes tr.first th').innerText");
    assert!(mark.as_str().is_some_and(|m| m.starts_with('▶')), "{mark}");
    let keys = browser.value(
        "[...document.querySelectorAll('.threes tbody tr')].map((r) => \
         Number(r.querySelector('td .key').innerText.slice(4)))",
    );
    let keys: Vec<u64> = serde_json::from_value(keys).expect("numbers");
    assert!(keys.is_sorted() && keys[0] > 0, "nearest first: {keys:?}");
}

fn picture(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    // The picture has 65 x 33 pixels; a frame of one pixel lies around it.
    for (at, pixel) in [([0.5, 0.5], [32, 16]), ([0.25, 0.75], [16, 24])] {
        browser.click_at(&format!("{SCENE} .shot"), at);
        assert_eq!(cursor(browser), pixel, "by its own picture");
        // Lists that come into sight move the page.
        browser.wait(&lists_of(pixel));
        browser.click_at(&format!("{SCENE} .canvas"), [1.0 - at[0], at[1]]);
        let mirrored = [64 - pixel[0], pixel[1]];
        assert_eq!(cursor(browser), mirrored, "by the large one");
        browser.wait(&lists_of(mirrored));
    }
    // Enlarged, the same place of the picture is the same pixel.
    browser.click(&format!("{SCENE} .in"));
    browser.click(&format!("{SCENE} .in"));
    let factor = browser.value("document.querySelector('.factor').value");
    assert_eq!(factor, "4×", "enlarged twice");
    let crisp =
        browser.value("getComputedStyle(document.querySelector('.canvas img')).imageRendering");
    assert_eq!(crisp, "pixelated", "pixels have edges");
    let [left, top, width, height] = browser.area(&format!("{SCENE} .canvas"));
    let at = [left + width * 48.5 / 65.0, top + height * 24.5 / 33.0];
    browser.mouse("mousePressed", at);
    browser.mouse("mouseReleased", at);
    assert_eq!(cursor(browser), [48, 24], "still in sight after enlarging");
}

fn keys(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    browser.key("n");
    browser.key("v");
    // Which of the pixels is the worst is not the same in every run, as the kernel races: away
    // from the border that is nearer.
    let [mut x, y] = cursor(browser);
    let (across, back, by) = match x < 32 {
        true => ("ArrowRight", "ArrowLeft", 1),
        false => ("ArrowLeft", "ArrowRight", -1),
    };
    let (down, y) = if y < 16 {
        ("ArrowDown", y + 1)
    } else {
        ("ArrowUp", y - 1)
    };
    for key in [across, across, down] {
        browser.key(key);
    }
    x += 2 * by;
    assert_eq!(cursor(browser), [x, y], "two across, one up or down");
    let open = "document.querySelector('.threes') !== null";
    assert_eq!(browser.value(open), json!(false), "not asked for");
    browser.key("Enter");
    browser.wait(open);
    browser.wait(&lists_of([x, y]));
    browser.key(back);
    x -= by;
    browser.wait(&lists_of([x, y]));
    // The worst pixels go on from where the cursor is, and round.
    let listed = browser.value(&format!(
        "[...document.querySelectorAll('{SCENE} .pixel')].map((p) => p.dataset.at.split(',').map(Number))"
    ));
    let listed: Vec<[i64; 2]> = serde_json::from_value(listed).expect("columns and rows");
    assert_eq!(listed.len(), 100, "as many as are named");
    browser.click(&format!("{SCENE} .pixel"));
    browser.wait(&lists_of(listed[0]));
    for (key, nth) in [("w", 1), ("w", 2), ("W", 1), ("W", 0), ("W", 99), ("w", 0)] {
        browser.key(key);
        browser.wait(&lists_of(listed[nth]));
    }
    browser.key("?");
    browser.wait("document.getElementById('keys').open");
    browser.key("Escape");
    browser.wait("!document.getElementById('keys').open");
}

fn slider(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    let shown = "parseFloat(getComputedStyle(document.querySelector('.divider')).left) / \
        document.querySelector('.canvas').clientWidth";
    let before = browser.value(shown).as_f64().expect("a share");
    assert!((before - 0.5).abs() < 0.01, "half of each: {before}");
    let [left, top, width, height] = browser.area(&format!("{SCENE} .split"));
    let at = |share: f64| [left + share * width, top + height / 2.0];
    browser.mouse("mousePressed", at(0.5));
    for share in [0.45, 0.35, 0.25] {
        browser.mouse("mouseMoved", at(share));
    }
    browser.mouse("mouseReleased", at(0.25));
    let after = browser.value(shown).as_f64().expect("a share");
    assert!((after - 0.25).abs() < 0.02, "a quarter: {after}");
    let clip = browser.value("getComputedStyle(document.querySelector('.over')).clipPath");
    assert!(
        clip.as_str()
            .is_some_and(|c| c.contains('%') || c.contains("px")),
        "{clip}"
    );
    browser.key("ArrowRight");
    let moved = browser.value(shown).as_f64().expect("a share");
    assert!(
        moved > after,
        "the slider has the focus: {moved} after {after}"
    );
}

fn index(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    let names = "[...document.querySelectorAll('.index tbody tr')].map((r) => r.dataset.name)";
    let both = json!(["abuffer/reversed", "abuffer/out-of-view"]);
    let divergence = browser.value("document.querySelector('.index tbody tr').dataset.verdict");
    assert_eq!(
        (browser.value(names), divergence),
        (both, json!("diverge")),
        "worst first"
    );
    let shown = "[...document.querySelectorAll('.index tbody tr')].filter((r) => \
        r.offsetHeight > 0).map((r) => r.dataset.name)";
    browser.key("/");
    browser.call("Input.insertText", json!({"text": "OUT-of"}));
    assert_eq!(
        browser.value(shown),
        json!(["abuffer/out-of-view"]),
        "by name"
    );
    browser.call("Input.insertText", json!({"text": "nonsense"}));
    assert_eq!(browser.value(shown), json!([]), "by name");
    browser.size([1280, 900]);
    let cut = browser.value(
        "(() => { const s = document.querySelector('.index').parentElement; \
         return s.scrollWidth - s.clientWidth; })()",
    );
    assert_eq!(cut, 0, "the last column is in sight");
}

fn phone(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, PHONE);
    browser.click(&format!("{SCENE} button.pixel"));
    browser.wait("document.querySelector('.threes tbody tr')");
    browser.value("document.querySelectorAll('details').forEach((d) => { d.open = true; })");
    let width = browser.value("document.documentElement.scrollWidth");
    assert_eq!(width, PHONE[0], "the page is as wide as the window");
    // What scrolls by itself may be wider; everything else is in sight.
    let wide = browser.value(
        "[...document.querySelectorAll('body *')].filter((e) => \
         !e.closest('.scroll, .stage, pre') && e.getBoundingClientRect().right > 391)\
         .map((e) => e.tagName + '.' + e.className)",
    );
    assert_eq!(wide, json!([]), "sticks out");
    let lists = browser.value(
        "(() => { const s = document.querySelector('.lists'); return s.scrollWidth - s.clientWidth; })()",
    );
    assert_eq!(lists, 0, "three lists fit next to each other");
}

fn plain(browser: &mut Browser, place: &Place) {
    browser.call(
        "Emulation.setScriptExecutionDisabled",
        json!({"value": true}),
    );
    browser.open(&place.page, WIDE);
    for (what, selector) in [
        ("a table of scenes", ".index tbody tr"),
        ("pictures", "details.scene[open] figure img"),
        ("where to begin", "details.scene[open] .lead"),
        ("comparisons", "details.scene[open] table.rows tr.first"),
        ("lists as text", "details.scene[open] .words .sides li"),
    ] {
        let there = format!("document.querySelector('{selector}') !== null");
        assert_eq!(browser.value(&there), json!(true), "{what}");
    }
    let dead = browser.value(
        "[...document.querySelectorAll('button, select, input')].filter((e) => \
         e.offsetHeight > 0).map((e) => e.className)",
    );
    assert_eq!(dead, json!([]), "nothing is shown that does nothing");
}

fn hostile(browser: &mut Browser, place: &Place) {
    browser.open(&place.page, WIDE);
    let purpose =
        browser.value("[...document.querySelectorAll('.purpose')].map((p) => p.innerText)");
    assert!(
        purpose.to_string().contains("onerror="),
        "it is shown: {purpose}"
    );
    let caught = "document.title === 'caught' || document.querySelector('img[src=x]') !== null";
    assert_eq!(browser.value(caught), json!(false), "it is text");
    let asked = browser.value("performance.getEntriesByType('resource').length");
    assert_eq!(asked, 0, "nothing is loaded from elsewhere");
}
