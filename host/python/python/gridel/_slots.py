"""Attributes that subclasses keep in ``__slots__``."""

from __future__ import annotations

from types import MemberDescriptorType
from typing import Any


def slots_of(value: Any, base: type) -> dict[str, Any]:
    """The attributes of an object that are in slots of its class, without those of ``base``."""
    kinds = [kind for kind in type(value).__mro__ if kind is not base and "__slots__" in vars(kind)]
    # By descriptors: they have the names of private attributes as these are stored.
    names = {name for kind in kinds for name, it in vars(kind).items() if isinstance(it, MemberDescriptorType)}
    return {name: getattr(value, name) for name in sorted(names) if hasattr(value, name)}


def state_of(attributes: dict[str, Any], slots: dict[str, Any]) -> Any:
    """The state of an object as ``pickle`` and ``copy`` take it; None if there is none."""
    return (attributes or None, slots) if slots else attributes or None


def restore(value: Any, state: Any) -> None:
    """Gives an object its state, as ``pickle`` does."""
    attributes, slots = state if isinstance(state, tuple) else (state, {})
    value.__dict__.update(attributes)
    for name, each in slots.items():
        setattr(value, name, each)
