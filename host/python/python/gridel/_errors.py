"""Errors that Python has no class for."""


class StructureError(ValueError, KeyError):
    """``accel`` names a structure that the scene does not hold: a ValueError, and also a KeyError."""

    # Not that of KeyError, which puts the sentence in quotation marks.
    __str__ = ValueError.__str__
