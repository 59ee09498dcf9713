//! Sweeps are what they say, and what is wrong is said.
