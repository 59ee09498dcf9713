//! Typed causes: why two legs differ. Every difference gets exactly one.

use serde::{Deserialize, Serialize};

/// Why an item differs. The comparers hold the decision procedures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Cause {
    /// A position or a corner lies outside the bound of its vertex stage, or neighbours
    /// do not meet.
    Vertex,
    /// A triangle covers a sample that it must not, or misses one that it must.
    Coverage,
    /// A fragment is in a list more than once.
    Duplicate,
    /// An address was handed out, but no list leads to its node.
    LostNode,
    /// A head or link leads outside the nodes, or into another pixel's list.
    CorruptLink,
    /// A list leads back into itself.
    Cycle,
    /// Counter, capacity and stored nodes do not agree.
    Overflow,
    /// The fragment is right, its depth key is not.
    DepthKey,
    /// Neighbours in a sorted list with different keys stand in the wrong order.
    SortOrder,
    /// Neighbours in a sorted list with equal keys stand in the wrong order.
    TieOrder,
    /// A value lies outside the bound that the spec gives it.
    Interval,
    /// A blended colour lies outside its bound although its list is right.
    BlendRounding,
    /// The fragment is right, its sample mask is not.
    SampleMask,
    /// Something of an earlier pass or frame shows through, or a pass reads what it
    /// writes itself.
    StalePass,
    /// Closer to an edge than the reference's own precision; counted, not judged.
    Edge,
    /// There was nothing to compare with.
    ReferenceMissing,
    /// The device went away.
    DeviceLost,
    /// Embree and the GPU agree against the spec, or Embree stands alone.
    OracleDisagreement,
}

impl Cause {
    /// Every cause, in order.
    pub const ALL: [Self; 18] = [
        Self::Vertex,
        Self::Coverage,
        Self::Duplicate,
        Self::LostNode,
        Self::CorruptLink,
        Self::Cycle,
        Self::Overflow,
        Self::DepthKey,
        Self::SortOrder,
        Self::TieOrder,
        Self::Interval,
        Self::BlendRounding,
        Self::SampleMask,
        Self::StalePass,
        Self::Edge,
        Self::ReferenceMissing,
        Self::DeviceLost,
        Self::OracleDisagreement,
    ];

    /// The cause's name as the command line, JSON and the report write it.
    pub fn name(self) -> String {
        serde_json::to_value(self)
            .ok()
            .and_then(|v| v.as_str().map(str::to_owned))
            .expect("a unit variant serialises as its name")
    }
}
