//! Axes of the front.

use maud::{Markup, html};

use super::ROUNDING;

/// Time, logarithmic.
pub(super) struct Horizontal {
    /// Decimal logarithms at the ends.
    low: f64,
    high: f64,
    place: [f64; 2],
}

impl Horizontal {
    /// An axis that holds these milliseconds.
    pub(super) fn of(times: impl Iterator<Item = f64>, place: [f64; 2]) -> Self {
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
        for time in times.filter(|t| *t > 0.0) {
            low = low.min(time.log10());
            high = high.max(time.log10());
        }
        if low > high {
            [low, high] = [0.0, 0.0];
        }
        // Room for the points, and an extent even for one of them.
        let room = 0.05 * (high - low).max(1.0);
        Self {
            low: low - room,
            high: high + room,
            place,
        }
    }

    pub(super) fn at(&self, time: f64) -> f64 {
        let share = (time.log10() - self.low) / (self.high - self.low);
        self.place[0] + share * (self.place[1] - self.place[0])
    }

    /// Vertical lines at 1, 2 and 5 times the powers of ten, or at more where the axis is
    /// short, with their numbers.
    pub(super) fn grid(&self, [top, bottom]: [f64; 2]) -> Markup {
        let steps: &[f64] = match self.high - self.low {
            ..1.2 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0],
            _ => &[1.0, 2.0, 5.0],
        };
        let powers = (-6..9).map(|power| 10_f64.powi(power));
        let ticks = powers.flat_map(|power| steps.iter().map(move |step| step * power));
        let inside = |t: &f64| (self.low..=self.high).contains(&t.log10());
        let middle = f64::midpoint(self.place[0], self.place[1]);
        html! {
            @for tick in ticks.filter(inside) {
                @let x = format!("{:.1}", self.at(tick));
                line.grid x1=(x) x2=(x) y1=(top) y2=(bottom) {}
                text.soft x=(x) y=(bottom + 16.0) text-anchor="middle" { (format!("{}", (tick * 1e6).round() / 1e6)) }
            }
            line.axis x1=(self.place[0]) x2=(self.place[1]) y1=(bottom) y2=(bottom) {}
            text.soft x=(middle) y=(bottom + 34.0) text-anchor="middle" { "time of a frame, ms (median, logarithmic)" }
        }
    }
}

/// Decibels, with a line of their own for what only rounding tells from exact.
pub(super) struct Vertical {
    low: f64,
    high: f64,
    place: [f64; 2],
}

/// Room at the top for that line.
const TOP: f64 = 30.0;

impl Vertical {
    /// An axis that holds these errors.
    pub(super) fn of(errors: impl Iterator<Item = Option<f64>>, place: [f64; 2]) -> Self {
        let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
        for error in errors.flatten().filter(|e| *e < ROUNDING) {
            low = low.min(error);
            high = high.max(error);
        }
        if low > high {
            [low, high] = [0.0, ROUNDING];
        }
        Self {
            low: (low / 10.0).floor() * 10.0,
            high: ((high / 10.0).floor() + 1.0) * 10.0,
            place,
        }
    }

    pub(super) fn at(&self, error: Option<f64>) -> f64 {
        let [top, bottom] = self.place;
        match error.filter(|e| *e < ROUNDING) {
            None => top + 4.0,
            Some(error) => {
                let share = (error - self.low) / (self.high - self.low);
                bottom - share * (bottom - top - TOP)
            }
        }
    }

    /// Horizontal lines at tens, with their numbers.
    pub(super) fn grid(&self, [left, right]: [f64; 2]) -> Markup {
        let step = if self.high - self.low > 60.0 {
            20.0
        } else {
            10.0
        };
        let tens = (0..20).map(|i| self.low + step * f64::from(i));
        let mut ticks: Vec<(Option<f64>, String)> = tens
            .take_while(|tick| *tick <= self.high && *tick < ROUNDING)
            .map(|tick| (Some(tick), format!("{tick}")))
            .collect();
        ticks.push((None, "exact*".to_owned()));
        html! {
            @for (error, words) in &ticks {
                @let y = format!("{:.1}", self.at(*error));
                line.grid x1=(left) x2=(right) y1=(y) y2=(y) {}
                text.soft x=(left - 8.0) y=(self.at(*error) + 4.0) text-anchor="end" { (words) }
            }
        }
    }
}
