//! Objects and groups as the file states them.

use super::source::{Name, Span};
use crate::scene::{Attributes, Placement, Scene, Shape};
use glam::{DAffine3, DVec3};
use std::rc::Rc;

/// An object as the file states it.
pub(super) struct Item {
    /// The name the file gives it, or one made of its kind and its number in its list.
    pub(super) name: String,
    pub(super) material: Option<Name>,
    /// The angle of `smooth`.
    pub(super) smooth: Option<f64>,
    /// The attributes of a mesh.
    pub(super) attributes: Attributes,
    pub(super) transform: DAffine3,
    pub(super) span: Span,
    pub(super) content: Content,
}

pub(super) enum Content {
    Shape(Shape),
    /// Objects that stand here and nowhere else.
    Group(Vec<Item>),
    /// The group of this name.
    Instance(Name),
    /// Another scene file, which of our materials each of its materials is, and which of our morph targets is its
    /// first.
    Import {
        scene: Rc<Scene>,
        materials: Vec<usize>,
        morphs: usize,
    },
}

/// A `[group.NAME]`.
pub(super) struct Group {
    pub(super) span: Span,
    pub(super) items: Vec<Item>,
}

/// A `[[part]]`.
pub(super) struct PartItem {
    pub(super) name: Name,
    pub(super) span: Span,
    pub(super) items: Vec<Item>,
}

/// An `[[instance]]`.
pub(super) struct InstanceItem {
    pub(super) name: String,
    /// Index of the part in the list.
    pub(super) part: usize,
    pub(super) placement: Placement,
    /// Index of the joint in the list.
    pub(super) joint: Option<usize>,
    pub(super) span: Span,
}

/// A `[[joint]]`.
pub(super) struct JointItem {
    pub(super) name: Name,
    /// Index of the parent in the list, before this one.
    pub(super) parent: Option<usize>,
    pub(super) pivot: DVec3,
    pub(super) span: Span,
}
