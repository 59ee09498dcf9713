//! Colours, where the terminal takes them.

use console::Style;

/// Whether to colour.
#[derive(Clone, Copy, Debug)]
pub struct Ink {
    /// The output is a terminal that takes colours, and nobody objects.
    pub colour: bool,
}

impl Ink {
    /// Text in a style, or as it is.
    pub fn paint(self, text: &str, style: impl Fn(Style) -> Style) -> String {
        if !self.colour {
            return text.to_owned();
        }
        let style = style(Style::new()).force_styling(true);
        style.apply_to(text).to_string()
    }
}
