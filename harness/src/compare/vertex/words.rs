//! Reports in words.

use std::fmt;

use super::{Difference, Kind, Stray, VertexReport};

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "triangle {}: ", self.triangle)?;
        match &self.kind {
            Kind::Count { expected, observed } => {
                write!(f, "{observed} corners after clipping, not {expected}")
            }
            Kind::Corner {
                corner,
                axis,
                value,
                bound,
                observed,
            } => {
                let axis = ["x", "y", "z", "w"][*axis];
                write!(
                    f,
                    "corner {corner}: {axis} is {observed}, not {value} within {bound:.3e}"
                )
            }
            Kind::Crack { corner, neighbour } => {
                write!(
                    f,
                    "corner {corner} is not where its neighbour {neighbour} has it"
                )
            }
            Kind::NoOutcome { outcomes, observed } => write!(
                f,
                "its {observed} corners match none of {outcomes} ways to clip it"
            ),
        }
    }
}

/// One line for people.
impl fmt::Display for VertexReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let figures = &self.figures;
        let worst = figures.error_over_bound;
        write!(f, "{} corners, ", self.corners)?;
        if figures.bound_subpixels > 0.0 {
            write!(
                f,
                "{} moved, off by up to {:.3} of at most {:.3} sub-pixels and {:.0} keys \
                 ({worst:.2} of the bound)",
                figures.moved, figures.error_subpixels, figures.bound_subpixels, figures.error_keys,
            )?;
        } else {
            write!(f, "off by up to {worst:.2} of the bound")?;
        }
        let counts = [
            (self.decisions, "triangles with an uncertain branch"),
            (self.undecided, "triangles undecided"),
            (figures.unbounded, "corners unbounded"),
            (self.cracks, "triangles that do not meet a neighbour"),
        ];
        for (count, what) in counts.iter().filter(|(count, _)| *count > 0) {
            write!(f, ", {count} {what}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Stray {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let component = ["x", "y", "z", "w"][self.component];
        let (value, bound) = (self.expected.value, self.expected.bound);
        write!(
            f,
            "vertex {}: {component} is {}, not {value} within {bound:.3e}",
            self.vertex, self.observed
        )
    }
}
