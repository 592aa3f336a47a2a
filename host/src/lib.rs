//! The host side of Gridel: scene files to blobs, blobs to pictures and hits.
pub mod blob;
pub mod compile;
pub mod render;
pub mod sample;
pub mod scene;
pub mod trace;
