//! Why a replay ends before its end.

/// Why a replay ends early.
pub(super) enum Stop {
    /// Bad input.
    Input(String),
    /// A dump that cannot be written.
    Dump(std::io::Error),
}

impl Stop {
    /// In one line.
    pub(super) fn words(self) -> String {
        match self {
            Self::Input(message) => message,
            Self::Dump(error) => format!("dump: {error}"),
        }
    }
}

impl From<std::io::Error> for Stop {
    fn from(error: std::io::Error) -> Self {
        Self::Dump(error)
    }
}
