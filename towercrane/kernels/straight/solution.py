"""Loops in machine code that solve a symmetric system: straight code of a large one would outgrow the processor."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from llvmlite import ir
from numba.core import cgutils

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

INTEGER = ir.IntType(64)


class Solution:
    """The operations of :func:`towercrane.kernels.algebra.solved`, in their order, where a builder stands.

    Parameters
    ----------
    builder
        Numba's.
    count : int
        Unknowns.
    one : LLVM value
        A number or a lane vector.
    root : callable
        Square root of such a value.
    """

    def __init__(self, builder: Any, count: int, one: Any, root: Callable[[Any], Any]) -> None:
        self.builder, self.count, self.one, self.root = builder, count, one, root
        sizes = count * count, count
        self.matrix, self.right = (cgutils.alloca_once(builder, one.type, size=_whole(size)) for size in sizes)

    def write(self, entries: Sequence[Any]) -> list[Any]:
        """Solution from right sides and the rows of the lower triangle."""
        builder, count, at = self.builder, self.count, iter(entries)
        for i in range(count):
            self._store(next(at), self._right(_whole(i)))
        for i in range(count):
            for j in range(i + 1):
                self._store(next(at), self._entry(_whole(i), _whole(j)))
        with cgutils.for_range(builder, _whole(count)) as rows:
            self._factor_row(rows.index)
        with cgutils.for_range(builder, _whole(count)) as rows:
            i = builder.sub(_whole(count - 1), rows.index)
            value = self._less(self._load(self._right(i)), builder.add(i, _whole(1)), _whole(count), self._below(i))
            self._store(builder.fmul(value, self._load(self._entry(i, i))), self._right(i))
        return [self._load(self._right(_whole(i))) for i in range(count)]

    def _factor_row(self, i: Any) -> None:
        builder = self.builder
        with cgutils.for_range(builder, i) as columns:
            j = columns.index
            value = self._less(self._load(self._entry(i, j)), _whole(0), j, self._rows(i, j))
            self._store(builder.fmul(value, self._load(self._entry(j, j))), self._entry(i, j))
        value = self._less(self._load(self._entry(i, i)), _whole(0), i, self._rows(i, i))
        self._store(builder.fdiv(self.one, self.root(value)), self._entry(i, i))
        value = self._less(self._load(self._right(i)), _whole(0), i, lambda m: (self._entry(i, m), self._right(m)))
        self._store(builder.fmul(value, self._load(self._entry(i, i))), self._right(i))

    def _rows(self, i: Any, j: Any) -> Any:
        return lambda m: (self._entry(i, m), self._entry(j, m))

    def _below(self, i: Any) -> Any:
        return lambda m: (self._entry(m, i), self._right(m))

    def _less(self, value: Any, first: Any, last: Any, factors: Any) -> Any:
        """A value less the products of pairs of factors, one after the other."""
        left = cgutils.alloca_once_value(self.builder, value)
        with cgutils.for_range(self.builder, last, start=first) as columns:
            product = self.builder.fmul(*(self._load(pointer) for pointer in factors(columns.index)))
            self.builder.store(self.builder.fsub(self.builder.load(left), product), left)
        return self.builder.load(left)

    def _entry(self, i: Any, j: Any) -> Any:
        return self.builder.gep(self.matrix, [self.builder.add(self.builder.mul(i, _whole(self.count)), j)])

    def _right(self, i: Any) -> Any:
        return self.builder.gep(self.right, [i])

    def _load(self, pointer: Any) -> Any:
        return self.builder.load(pointer)

    def _store(self, value: Any, pointer: Any) -> None:
        self.builder.store(value, pointer)


def _whole(number: int) -> Any:
    return ir.Constant(INTEGER, number)
