//! Exact surfaces.
