//! Values of a scene file that are checked where they are read, so that an error
//! carries the line of the value itself.

use std::fmt;
use std::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error as _, IgnoredAny, SeqAccess, Visitor};
use triptych_spec::scene::Size;
use triptych_spec::vertex::TARGET_MAX;

/// Largest colour component and light intensity. Blending and shading then stay
/// far from the largest `f32`, whatever the order of the sums.
pub const COLOUR_MAX: f64 = 1e6;

/// A finite number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct Number(pub f64);

impl TryFrom<f64> for Number {
    type Error = String;
    fn try_from(v: f64) -> Result<Self, String> {
        match v.is_finite() {
            true => Ok(Self(v)),
            false => Err(format!("{v} is not a finite number")),
        }
    }
}

/// Three finite numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "Exactly<f64, 3>")]
pub struct Point(pub [f64; 3]);

impl TryFrom<Exactly<f64, 3>> for Point {
    type Error = String;
    fn try_from(Exactly(v): Exactly<f64, 3>) -> Result<Self, String> {
        match v.iter().find(|x| !x.is_finite()) {
            None => Ok(Self(v)),
            Some(x) => Err(format!("{x} is not a finite number")),
        }
    }
}

/// Three finite numbers that are not all zero.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Exactly<f64, 3>")]
pub struct Direction(pub [f64; 3]);

impl TryFrom<Exactly<f64, 3>> for Direction {
    type Error = String;
    fn try_from(v: Exactly<f64, 3>) -> Result<Self, String> {
        let Point(v) = Point::try_from(v)?;
        match v == [0.0; 3] {
            false => Ok(Self(v)),
            true => Err("a direction must not be zero".to_owned()),
        }
    }
}

/// Linear red, green and blue, each from 0 to [`COLOUR_MAX`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "Exactly<f64, 3>")]
pub struct Colour(pub [f64; 3]);

impl TryFrom<Exactly<f64, 3>> for Colour {
    type Error = String;
    fn try_from(Exactly(v): Exactly<f64, 3>) -> Result<Self, String> {
        match v.iter().find(|x| !(0.0..=COLOUR_MAX).contains(*x)) {
            None => Ok(Self(v)),
            Some(x) => Err(format!("{x} is outside 0 to {COLOUR_MAX:e}")),
        }
    }
}

/// A share of red, green and blue, each from 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "Exactly<f64, 3>")]
pub struct Shares(pub [f64; 3]);

impl TryFrom<Exactly<f64, 3>> for Shares {
    type Error = String;
    fn try_from(Exactly(v): Exactly<f64, 3>) -> Result<Self, String> {
        match v.iter().find(|x| !(0.0..=1.0).contains(*x)) {
            None => Ok(Self(v)),
            Some(x) => Err(format!("{x} is outside 0 to 1")),
        }
    }
}

/// A share, from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "f64")]
pub struct Share(pub f64);

impl TryFrom<f64> for Share {
    type Error = String;
    fn try_from(v: f64) -> Result<Self, String> {
        match (0.0..=1.0).contains(&v) {
            true => Ok(Self(v)),
            false => Err(format!("{v} is outside 0 to 1")),
        }
    }
}

/// One sentence.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "String")]
pub struct Sentence(pub String);

impl TryFrom<String> for Sentence {
    type Error = &'static str;
    fn try_from(v: String) -> Result<Self, &'static str> {
        match v.trim().is_empty() || v.contains(['\n', '\r']) {
            false => Ok(Self(v)),
            true => Err("say in one line what the scene is for"),
        }
    }
}

/// Width and height in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Exactly<i64, 2>")]
pub struct ImageSize(pub Size);

impl TryFrom<Exactly<i64, 2>> for ImageSize {
    type Error = String;
    fn try_from(Exactly(v): Exactly<i64, 2>) -> Result<Self, String> {
        let side = |v: i64| match u32::try_from(v) {
            Ok(side) if (1..=TARGET_MAX).contains(&side) => Ok(side),
            _ => Err(format!("{v} is outside 1 to {TARGET_MAX} pixels")),
        };
        Ok(Self(Size {
            width: side(v[0])?,
            height: side(v[1])?,
        }))
    }
}

impl ImageSize {
    /// As high as wide.
    pub(super) fn square(side: u32) -> Self {
        Self(Size {
            width: side,
            height: side,
        })
    }
}

/// How many nodes the first attempt at building lists may use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(try_from = "toml::Value")]
pub enum Capacity {
    /// As many as are needed: `"all"`.
    #[default]
    All,
    /// So many fewer than are needed: `"all-1"`.
    AllBut(u32),
    /// A fixed number.
    Nodes(u32),
}

impl TryFrom<toml::Value> for Capacity {
    type Error = String;
    fn try_from(v: toml::Value) -> Result<Self, String> {
        let parsed = match &v {
            toml::Value::String(s) if s == "all" => Some(Self::All),
            toml::Value::String(s) => s
                .strip_prefix("all-")
                .and_then(|n| n.parse().ok())
                .map(Self::AllBut),
            toml::Value::Integer(n) => u32::try_from(*n).ok().map(Self::Nodes),
            _ => None,
        };
        parsed.ok_or_else(|| format!("{v} is neither \"all\", \"all-N\" nor a number of nodes"))
    }
}

impl Capacity {
    /// The capacity in nodes, for a scene that needs `needed`.
    pub fn nodes(self, needed: u32) -> u32 {
        match self {
            Self::All => needed,
            Self::AllBut(n) => needed.saturating_sub(n),
            Self::Nodes(n) => n,
        }
    }
}

/// A factor for all axes, or one for each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "toml::Value")]
pub struct Scale(pub [f64; 3]);

impl Default for Scale {
    fn default() -> Self {
        Self([1.0; 3])
    }
}

impl TryFrom<toml::Value> for Scale {
    type Error = String;
    fn try_from(v: toml::Value) -> Result<Self, String> {
        let axes = match v {
            toml::Value::Array(_) => v.clone().try_into::<Exactly<f64, 3>>().ok(),
            _ => v.clone().try_into::<f64>().ok().map(|s| Exactly([s; 3])),
        };
        let axes = axes.ok_or_else(|| format!("{v} is neither a number nor three"))?;
        Point::try_from(axes).map(|Point(s)| Self(s))
    }
}

/// An array of `N` items, neither fewer nor more; serde's own ignores those beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exactly<T, const N: usize>(pub [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(list: D) -> Result<Self, D::Error> {
        exactly(list).map(Self)
    }
}

/// Reads what [`Exactly`] holds.
pub fn exactly<'de, const N: usize, T, D>(list: D) -> Result<[T; N], D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    list.deserialize_seq(ExactlyVisitor::<N, T>(PhantomData))
}

struct ExactlyVisitor<const N: usize, T>(PhantomData<T>);

impl<'de, const N: usize, T: Deserialize<'de>> Visitor<'de> for ExactlyVisitor<N, T> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "an array of length {N}")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<[T; N], A::Error> {
        let mut items = Vec::with_capacity(N);
        while items.len() < N
            && let Some(item) = list.next_element()?
        {
            items.push(item);
        }
        let mut count = items.len();
        while list.next_element::<IgnoredAny>()?.is_some() {
            count += 1;
        }
        let items = <[T; N]>::try_from(items).ok().filter(|_| count == N);
        items.ok_or_else(|| A::Error::invalid_length(count, &self))
    }
}

/// A list of at most `N` items; reading stops there.
pub fn at_most<'de, const N: usize, T, D>(list: D) -> Result<Vec<T>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    list.deserialize_seq(AtMost::<N, T>(PhantomData))
}

struct AtMost<const N: usize, T>(PhantomData<T>);

impl<'de, const N: usize, T: Deserialize<'de>> Visitor<'de> for AtMost<N, T> {
    type Value = Vec<T>;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "an array of at most {N} items")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<T>, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element()? {
            if items.len() == N {
                return Err(A::Error::custom(format!("more than {N} items, the limit")));
            }
            items.push(item);
        }
        Ok(items)
    }
}
