"""Straight algebra inside compiled kernels, traced instead of compiled.

The equations of a crane in space are hundreds of sums and products without a branch or a loop. Numba takes about a
millisecond for each of them, from byte code to machine code. A traced function is called once, as Python, with
operands that write down what is done to them: the same instructions in the same order, in a hundredth of the time.
"""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np import arrayobj

if TYPE_CHECKING:
    from collections.abc import Callable

# Numba's own functions carry no types.
_intrinsic: Any = intrinsic
_arrays: Any = arrayobj
_types: Any = types
_pointer: Any = cgutils.get_item_pointer


class _Operand:
    """A number, or what numbers convert to, that is known when the kernel runs; without a builder only a type."""

    def __init__(self, kind: Any, value: Any = None, context: Any = None, builder: Any = None) -> None:
        self.kind, self.value, self.context, self.builder = kind, value, context, builder

    @property
    def is_whole(self) -> bool:
        """Whether it is an integer."""
        return isinstance(self.kind, types.Integer)

    def _with(self, instruction: str, other: Any, *, swapped: bool = False) -> _Operand:
        a, b = (_operand(other), self) if swapped else (self, _operand(other))
        whole = instruction != "div" and a.is_whole and b.is_whole
        wider = (own for own in (a.kind, b.kind) if not isinstance(own, types.Number))
        kind = types.int64 if whole else next(wider, types.float64)
        if self.builder is None:
            return _Operand(kind)
        values = (self.context.cast(self.builder, operand.value, operand.kind, kind) for operand in (a, b))
        build = getattr(self.builder, instruction if whole else f"f{instruction}")
        return _Operand(kind, build(*values), self.context, self.builder)

    def __add__(self, other: Any) -> _Operand:
        return self._with("add", other)

    def __radd__(self, other: Any) -> _Operand:
        return self._with("add", other, swapped=True)

    def __sub__(self, other: Any) -> _Operand:
        return self._with("sub", other)

    def __rsub__(self, other: Any) -> _Operand:
        return self._with("sub", other, swapped=True)

    def __mul__(self, other: Any) -> _Operand:
        return self._with("mul", other)

    def __rmul__(self, other: Any) -> _Operand:
        return self._with("mul", other, swapped=True)

    def __truediv__(self, other: Any) -> _Operand:
        return self._with("div", other)

    def __rtruediv__(self, other: Any) -> _Operand:
        return self._with("div", other, swapped=True)

    def __neg__(self) -> _Operand:
        if self.builder is None:
            return _Operand(self.kind)
        value = self.builder.neg(self.value) if self.is_whole else self.builder.fneg(self.value)
        return _Operand(self.kind, value, self.context, self.builder)


class _Array:
    """An array, read and written item by item at places that are not negative."""

    def __init__(self, kind: Any, value: Any = None, context: Any = None, builder: Any = None) -> None:
        self.kind, self.context, self.builder = kind, context, builder
        self.array = None if builder is None else _arrays.make_array(kind)(context, builder, value)

    def _at(self, place: Any) -> Any:
        indices = [_operand(index).value for index in (place if isinstance(place, tuple) else (place,))]
        return _pointer(self.context, self.builder, self.kind, self.array, indices)

    def __getitem__(self, place: Any) -> _Operand:
        if self.builder is None:
            return _Operand(self.kind.dtype)
        value = _arrays.load_item(self.context, self.builder, self.kind, self._at(place))
        return _Operand(self.kind.dtype, value, self.context, self.builder)

    def __setitem__(self, place: Any, item: Any) -> None:
        if self.builder is not None:
            operand = _operand(item)
            value = self.context.cast(self.builder, operand.value, operand.kind, self.kind.dtype)
            _arrays.store_item(self.context, self.builder, self.kind, value, self._at(place))


def _operand(item: Any) -> _Operand:
    """An operand, or a number that the traced function states."""
    if isinstance(item, _Operand):
        return item
    if isinstance(item, int):
        return _Operand(types.int64, ir.Constant(ir.IntType(64), item))
    return _Operand(types.float64, ir.Constant(ir.DoubleType(), item))


def _given(kind: Any, value: Any = None, context: Any = None, builder: Any = None) -> Any:
    """What a traced function is called with for an argument of this type."""
    if isinstance(kind, _types.BaseTuple):
        values = (None if builder is None else builder.extract_value(value, i) for i in range(len(kind)))
        return tuple(_given(part, own, context, builder) for part, own in zip(kind, values, strict=True))
    return (_Array if isinstance(kind, types.Array) else _Operand)(kind, value, context, builder)


def _kind(found: Any) -> Any:
    """Type of what a traced function returns."""
    if found is None:
        return types.none
    return _types.Tuple([_kind(part) for part in found]) if isinstance(found, tuple) else _operand(found).kind


def _value(found: Any, context: Any, builder: Any) -> Any:
    """Value of what a traced function returns."""
    if found is None:
        return context.get_dummy_value()
    if not isinstance(found, tuple):
        return _operand(found).value
    return context.make_tuple(builder, _kind(found), [_value(part, context, builder) for part in found])


def traced(function: Callable[..., Any]) -> Any:
    """Make a function of sums, products, quotients and items of arrays available to kernels.

    Parameters
    ----------
    function : callable
        Takes numbers, arrays, and tuples of them, nested as deep as you like; returns numbers in tuples, or nothing.
        What Python does with tuples, with functions it calls and with what is known beforehand leaves no trace in
        the kernel. As the numbers themselves are not known yet, it cannot ask about them: a branch on one, or a loop
        over so many, goes into the kernel.

    Returns
    -------
    callable
        For kernels; its ``py_func`` is the function as it was, which takes numbers or arrays of them.
    """

    def typed(_context: Any, *kinds: Any) -> Any:
        def build(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            given = zip(signature.args, arguments, strict=True)
            return _value(
                function(*(_given(kind, value, context, builder) for kind, value in given)), context, builder
            )

        return _kind(function(*map(_given, kinds)))(*kinds), build

    asked = inspect.Parameter("context", inspect.Parameter.POSITIONAL_ONLY)
    parameters = inspect.signature(function).parameters.values()
    typed.__signature__ = inspect.Signature([asked, *parameters])  # type: ignore[attr-defined]
    typed.__name__, typed.__doc__ = function.__name__, function.__doc__
    return spoken(_intrinsic(typed), function)


def spoken(made: Any, function: Callable[..., Any]) -> Any:
    """An intrinsic that Python can call: it is then the function as it stands."""

    def call(_self: Any, *arguments: Any) -> Any:
        return function(*arguments)

    made.__class__ = type("Spoken", (type(made),), {"__call__": call})
    made.py_func = function
    return made
