//! `gridel build`.

mod budget;
mod files;
mod module;
mod report;
