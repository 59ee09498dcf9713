//! The size of the page: what is left out of it, in which order, and that it is said.

use super::{ReportInput, SceneReport, page};
use crate::row::Verdict;
use crate::text::plural;

/// Largest page in bytes.
pub const PAGE_BYTES: usize = 30_000_000;

/// What can be left out. First what fewest people miss; of each kind the largest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Part {
    /// Embree's lists of a scene that agrees.
    AgreeingEmbree,
    /// The other lists of a scene that agrees.
    AgreeingLists,
    /// The pictures of a scene that agrees.
    AgreeingPictures,
    /// Embree's lists of a scene that diverges.
    Embree,
    /// The other lists of a scene that diverges.
    Lists,
    /// The pictures of a scene that diverges.
    Pictures,
}

impl Part {
    const ALL: [Self; 6] = [
        Self::AgreeingEmbree,
        Self::AgreeingLists,
        Self::AgreeingPictures,
        Self::Embree,
        Self::Lists,
        Self::Pictures,
    ];

    fn of_agreeing(self) -> bool {
        self < Self::Embree
    }

    /// Takes the part from a scene; gives how many bytes that saves, and what it was.
    fn take(self, scene: &mut SceneReport) -> (usize, &'static str) {
        let is_embree = |leg: &str| leg == "embree";
        match self {
            Self::AgreeingEmbree | Self::Embree => {
                let out = scene.sheets.extract_if(.., |s| is_embree(&s.leg));
                (out.map(|s| base64(s.data.len())).sum(), "Embree's lists")
            }
            Self::AgreeingLists | Self::Lists => {
                let out = scene.sheets.extract_if(.., |s| !is_embree(&s.leg));
                (
                    out.map(|s| base64(s.data.len())).sum(),
                    "the lists of spec and GPU legs",
                )
            }
            Self::AgreeingPictures | Self::Pictures => {
                let out = scene.pictures.drain(..);
                (out.map(|p| base64(p.image.png.len())).sum(), "the pictures")
            }
        }
    }
}

/// Bytes in base64.
fn base64(bytes: usize) -> usize {
    bytes.div_ceil(3) * 4
}

/// The page, with whatever must be left out of it to have at most `most` bytes; each
/// scene says what it lacks. Words are never left out: if they alone are too many, the
/// page is larger.
pub fn fit(input: &ReportInput, most: usize) -> String {
    let mut whole = page(input).into_string();
    if whole.len() <= most {
        return whole;
    }
    let mut input = input.clone();
    for part in Part::ALL {
        let mut sizes: Vec<(usize, usize)> = (0..input.scenes.len())
            .filter(|&i| (input.scenes[i].verdict() != Verdict::Diverge) == part.of_agreeing())
            .map(|i| (part.take(&mut input.scenes[i].clone()).0, i))
            .filter(|(size, _)| *size > 0)
            .collect();
        // Of equal size, the later scene first.
        sizes.sort_unstable();
        while let Some((_, i)) = sizes.pop() {
            let mut excess = whole.len() - most;
            // As many as are needed by their sizes; then the page is made again.
            let mut next = Some(i);
            while let Some(i) = next {
                let (size, what) = part.take(&mut input.scenes[i]);
                let limit = plural(most as u64, "byte");
                let words = format!("Left out to keep this page within {limit}: {what}.");
                input.scenes[i].left_out.push(words);
                excess = excess.saturating_sub(size);
                next = (excess > 0).then(|| sizes.pop()).flatten().map(|(_, i)| i);
            }
            whole = page(&input).into_string();
            if whole.len() <= most {
                return whole;
            }
        }
    }
    whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::digest::tests::row;
    use crate::picture;
    use crate::report::Picture;
    use crate::sheet::Sheet;
    use triptych_spec::scene::Size;

    fn scene(name: &str, differ: u64, bytes: usize) -> SceneReport {
        let size = Size {
            width: 1,
            height: 1,
        };
        let sheet = |leg: &str| Sheet {
            leg: leg.into(),
            // Equal bytes would be in the page once.
            data: vec![leg.as_bytes()[0]; bytes],
            ..Sheet::default()
        };
        let mut image = picture::linear(size, &[[0.5; 3]]);
        image.png = vec![9; bytes];
        SceneReport {
            name: name.into(),
            size: Some(size),
            rows: vec![crate::row::Row {
                differ,
                ..row(name, "build", "spec", "gpu@x/compute")
            }],
            sheets: vec![sheet("spec"), sheet("embree")],
            pictures: vec![Picture {
                title: "spec".into(),
                caption: String::new(),
                image,
            }],
            ..SceneReport::default()
        }
    }

    /// Which scenes lack what, in the order in which it went.
    fn lacks(page: &str) -> Vec<(&str, &str)> {
        let mut found = Vec::new();
        for part in page.split("<details class=\"scene\"").skip(1) {
            let name = part
                .split("data-name=\"")
                .nth(1)
                .and_then(|p| p.split('"').next());
            for words in part.split("bytes: ").skip(1) {
                found.push((
                    name.unwrap_or_default(),
                    words.split('.').next().unwrap_or_default(),
                ));
            }
        }
        found
    }

    #[test]
    fn what_is_left_out_goes_in_order_and_is_named() {
        let input = ReportInput {
            scenes: vec![
                scene("a/bad", 1, 90_000),
                scene("a/good", 0, 60_000),
                scene("a/more", 0, 75_000),
            ],
            ..ReportInput::default()
        };
        let whole = page(&input).into_string().len();
        let at = |most: usize| {
            let page = fit(&input, most);
            assert!(page.len() <= most, "{} bytes, at most {most}", page.len());
            page
        };
        assert_eq!(lacks(&at(whole)), [], "all fits");
        let (embree, lists) = ("Embree's lists", "the lists of spec and GPU legs");
        assert_eq!(lacks(&at(whole - 1)), [("a/more", embree)]);
        let less = at(whole - 100_000 - 1);
        assert_eq!(lacks(&less), [("a/good", embree), ("a/more", embree)]);
        let less = at(whole - 200_000);
        assert_eq!(
            lacks(&less),
            [("a/good", embree), ("a/more", embree), ("a/more", lists)]
        );
        let least = fit(&input, 2);
        assert_eq!(lacks(&least).len(), 9, "three things of three scenes");
        assert!(!least.contains("data:image/png;base64,CQkJ"), "no picture");
        assert!(least.contains("a/bad"), "words stay");
    }
}
