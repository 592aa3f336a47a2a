"""Arrays in place of Open3D's tensors, and conversion from and to tensors."""

from __future__ import annotations

import math
import re
import sys
from typing import Any, Optional

import numpy as np

from ._arguments import flag, integer

#: A device as Open3D writes it.
_DEVICE = re.compile(r"(CPU|CUDA|SYCL)(:\d+)?", re.IGNORECASE)


def _is_of_open3d(value: Any) -> bool:
    return type(value).__module__.partition(".")[0] == "open3d"


def is_tensor(value: Any) -> bool:
    """Returns true if a value is a tensor of Open3D."""
    return _is_of_open3d(value) and hasattr(value, "numpy")


def is_device(value: Any) -> bool:
    """Returns true if a value is a device of Open3D, or the name of one."""
    if isinstance(value, str):
        return _DEVICE.fullmatch(value) is not None
    return _is_of_open3d(value) and type(value).__name__ == "Device"


def array_of(value: Any, what: str) -> np.ndarray:
    """A tensor, or what NumPy takes, as an array."""
    if is_tensor(value):
        return value.numpy()
    array = np.asarray(value)
    if array.ndim == 0 and array.dtype == object:
        kind = f"{type(value).__module__}.{type(value).__qualname__}"
        raise TypeError(f"{what} is a {kind}; it must be an array or a tensor")
    return array


def like(given: Any, result: np.ndarray) -> Any:
    """Returns the result in the form of the argument."""
    if is_tensor(given):
        # Not by `ascontiguousarray`, which makes a row of one number.
        return sys.modules["open3d"].core.Tensor(np.require(result, requirements="C"))
    return result.view(Array)


def _plain(value: Any) -> Any:
    """A value with arrays of NumPy's in place of tensors and of arrays of this module, also inside of sequences."""
    if isinstance(value, Array):
        return value.view(np.ndarray)
    if is_tensor(value):
        return value.numpy()
    if type(value) in (tuple, list):
        return type(value)(_plain(each) for each in value)
    if type(value) is dict:
        return {key: _plain(each) for key, each in value.items()}
    return value


def _wrapped(found: Any) -> Any:
    """A result of NumPy's: one number is a tensor too."""
    if isinstance(found, (tuple, list)):
        wrapped = [_wrapped(each) for each in found]
        return type(found)(*wrapped) if hasattr(found, "_fields") else type(found)(wrapped)
    return np.asarray(found).view(Array) if isinstance(found, (np.ndarray, np.generic)) else found


def _dtype_of(value: Any) -> np.dtype:
    """A type of NumPy's or Open3D's."""
    try:
        return np.dtype(str(value).lower() if _is_of_open3d(value) else value)
    except TypeError:
        raise TypeError(f"dtype is {value!r}; it must be a type of NumPy's or Open3D's") from None


def _of_elements(function: Any, says: str) -> Any:
    """A method that is a function of each number, or of each pair of numbers."""

    def method(self: "Array", *values: Any) -> "Array":
        return _wrapped(np.asarray(function(self, *values)))

    method.__doc__ = f"Returns {says}."
    return method


def _quotients(one: "Array", other: Any) -> Any:
    """Quotients; those of integers are integers, rounded towards 0, as Open3D has them."""
    numbers, other = one.numpy(), _plain(other)
    if numbers.dtype.kind not in "iu" or np.result_type(numbers, other).kind not in "iu":
        return np.divide(numbers, other)
    below = np.floor_divide(numbers, other)
    return below + ((np.remainder(numbers, other) != 0) & ((numbers < 0) != (np.asarray(other) < 0)))


def _with_others(name: str) -> Any:
    """A method of NumPy's whose arguments may be tensors."""
    inner = getattr(np.ndarray, name)

    def method(self: "Array", *args: Any, **kwargs: Any) -> Any:
        return _wrapped(inner(self.numpy(), *_plain(args), **_plain(kwargs)))

    method.__name__ = name
    method.__doc__ = inner.__doc__
    return method


def _over_dimensions(name: str, says: str) -> Any:
    """A method of NumPy's over ``axis``, which takes Open3D's ``dim`` and ``keepdim`` as well."""
    inner = getattr(np.ndarray, name)

    def method(
        self: "Array", axis: Any = None, *args: Any, dim: Any = None, keepdim: bool = False, **kwargs: Any
    ) -> "Array":
        axis = axis if dim is None else dim
        if axis is not None and np.ndim(axis) == 1:
            axis = tuple(axis)
            if name.startswith("arg") and len(axis) != 1:
                # NumPy searches one dimension, or all of them.
                if sorted(each % self.ndim for each in axis) != list(range(self.ndim)):
                    raise ValueError(f"dim is {axis}; {name} takes one dimension or all")
                axis = None
            elif len(axis) == 1:
                axis = axis[0]
        # Behind the dimensions Open3D has `keepdim`, and NumPy a type or an array.
        if args and isinstance(args[0], (int, np.bool_)):
            keepdim, args = bool(args[0]), args[1:]
        if keepdim:
            kwargs["keepdims"] = True
        return _wrapped(np.asarray(inner(self.numpy(), axis, *_plain(args), **_plain(kwargs))))

    method.__name__ = name
    method.__doc__ = f"Returns {says}, of all numbers or along dimensions."
    return method


class Array(np.ndarray):
    """A NumPy array with the methods of Open3D's tensors that code for ray casting calls.

    Open3D takes it where it takes a tensor or an array. What both have is NumPy's where they differ: ``T`` is an
    attribute, ``shape`` a tuple, and ``dtype`` a NumPy type, which Open3D's types cannot be compared with.
    """

    isfinite = _of_elements(np.isfinite, "which numbers are finite")
    isinf = _of_elements(np.isinf, "which numbers are infinite")
    isnan = _of_elements(np.isnan, "which numbers are nan")
    logical_not = _of_elements(np.logical_not, "which numbers are 0 or false")
    abs = _of_elements(np.abs, "absolute values")
    neg = _of_elements(np.negative, "numbers with the other sign")
    sqrt = _of_elements(np.sqrt, "square roots")
    exp = _of_elements(np.exp, "powers of e")
    sin = _of_elements(np.sin, "sines")
    cos = _of_elements(np.cos, "cosines")
    floor = _of_elements(np.floor, "numbers rounded down")
    ceil = _of_elements(np.ceil, "numbers rounded up")
    trunc = _of_elements(np.trunc, "numbers rounded towards 0")
    logical_and = _of_elements(np.logical_and, "where both are true")
    logical_or = _of_elements(np.logical_or, "where either is true")
    logical_xor = _of_elements(np.logical_xor, "where one of both is true")
    add = _of_elements(np.add, "sums")
    sub = _of_elements(np.subtract, "differences")
    mul = _of_elements(np.multiply, "products")
    div = _of_elements(_quotients, "quotients; those of integers are rounded towards 0")
    eq = _of_elements(np.equal, "where numbers are equal")
    ne = _of_elements(np.not_equal, "where numbers differ")
    lt = _of_elements(np.less, "where numbers are less")
    le = _of_elements(np.less_equal, "where numbers are less or equal")
    gt = _of_elements(np.greater, "where numbers are greater")
    ge = _of_elements(np.greater_equal, "where numbers are greater or equal")
    min = _over_dimensions("min", "the least number")
    max = _over_dimensions("max", "the greatest number")
    sum = _over_dimensions("sum", "the sum")
    mean = _over_dimensions("mean", "the mean")
    prod = _over_dimensions("prod", "the product")
    any = _over_dimensions("any", "whether any number is true")
    all = _over_dimensions("all", "whether all numbers are true")
    argmin = _over_dimensions("argmin", "where the least number is")
    argmax = _over_dimensions("argmax", "where the greatest number is")

    def numpy(self) -> np.ndarray:
        """Returns the plain array, without a copy."""
        return self.view(np.ndarray)

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> Any:
        found = getattr(ufunc, method)(*_plain(inputs), **_plain(kwargs))
        out = kwargs.get("out")
        if out is not None:
            return out[0] if len(out) == 1 else out
        return _wrapped(found)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        found = function(*_plain(args), **_plain(kwargs))
        out = kwargs.get("out")
        return _wrapped(found) if out is None else out

    def __getitem__(self, key: Any) -> "Array":
        return _wrapped(self.numpy()[_plain(key)])

    def __setitem__(self, key: Any, value: Any) -> None:
        self.numpy()[_plain(key)] = _plain(value)

    def matmul(self, value: Any) -> "Array":
        """Returns the matrix product."""
        return np.matmul(self, value)

    def isclose(self, other: Any, rtol: float = 1e-5, atol: float = 1e-8) -> "Array":
        """Returns where numbers are nearly equal."""
        return np.isclose(self, other, rtol, atol)

    def allclose(self, other: Any, rtol: float = 1e-5, atol: float = 1e-8) -> bool:
        """Returns whether all numbers are nearly equal."""
        return bool(np.allclose(self, other, rtol, atol))

    def append(self, values: Any, axis: Optional[int] = None) -> "Array":
        """Returns the array with others behind it, all in one row where there is no axis."""
        return np.append(self, values, axis)

    # NumPy's order takes the place of the first dimension.
    def flatten(self, start_dim: Any = 0, end_dim: int = -1, *, order: str = "C") -> "Array":  # type: ignore[override]
        """Returns a copy with the dimensions from ``start_dim`` to ``end_dim``, inclusive, made one."""
        if isinstance(start_dim, str):
            start_dim, order = 0, start_dim
        if self.ndim == 0 or order != "C":
            return super().flatten(order)
        first, last = (self._dimension(dim, name) for dim, name in ((start_dim, "start_dim"), (end_dim, "end_dim")))
        if first > last:
            raise ValueError(f"start_dim is {start_dim}, which is behind end_dim, {end_dim}")
        return self.copy().reshape(self.shape[:first] + (math.prod(self.shape[first : last + 1]),) + self.shape[last + 1 :])

    def _dimension(self, value: Any, what: str) -> int:
        """The number of a dimension; those below 0 count from the last."""
        return integer(value, what, -self.ndim, self.ndim - 1) % self.ndim

    def num_elements(self) -> int:
        """Returns how many numbers there are."""
        return self.size

    def clone(self) -> "Array":
        """Returns a copy."""
        return self.copy()

    def cpu(self) -> "Array":
        """Returns itself: arrays are in the memory of the processor."""
        return self

    def contiguous(self) -> "Array":
        """Returns the array in C order, without a copy where it is so."""
        return np.require(self, requirements="C").view(Array)

    def is_contiguous(self) -> bool:
        """Returns whether the array is in C order."""
        return self.flags.c_contiguous

    def to(self, *arguments: Any, device: Any = None, dtype: Any = None, copy: Any = None) -> "Array":
        """Converts to a type of NumPy's or Open3D's: ``to(dtype, copy)``, ``to(device, copy)``, ``to(device, dtype, copy)``.

        A device of Open3D's, or its name, such as ``"CPU:0"``, changes nothing. With ``copy=True`` the result is always a
        copy.
        """
        rest = list(arguments)
        if rest and device is None and is_device(rest[0]):
            device = rest.pop(0)
        if rest and dtype is None and not isinstance(rest[0], (bool, np.bool_)):
            dtype = rest.pop(0)
        if rest and copy is None:
            copy = rest.pop(0)
        if rest or device is None and dtype is None:
            raise TypeError("to takes a dtype, a device or both, and whether to copy")
        if device is not None and not is_device(device):
            raise TypeError(f"device is {device!r}; it must be a device of Open3D's, or its name, such as 'CPU:0'")
        copy = flag(False if copy is None else copy, "copy")
        kind = self.dtype if dtype is None else _dtype_of(dtype)
        return self.astype(kind, copy=copy)


for _name in ("dot", "searchsorted", "take", "compress", "clip", "choose"):
    setattr(Array, _name, _with_others(_name))
Array.__module__ = "gridel.open3d"
