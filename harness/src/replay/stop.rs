//! Why a replay ends before its end.

use crate::scene::Mistake;

/// Why a replay ends early.
pub(super) enum Stop {
    /// Bad input.
    Input(Mistake),
    /// A dump that cannot be written.
    Dump(std::io::Error),
}

impl Stop {
    /// In one line, with the key that is to blame.
    pub(super) fn mistake(self) -> Mistake {
        match self {
            Self::Input(mistake) => mistake,
            Self::Dump(error) => format!("dump: {error}").into(),
        }
    }
}

impl From<std::io::Error> for Stop {
    fn from(error: std::io::Error) -> Self {
        Self::Dump(error)
    }
}
