"""Compiled functions do what they do as Python; what cannot be compiled is refused, what is damaged is made anew."""

import ctypes
import math
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import NamedTuple

import numpy as np
import pytest

from modal.compiler import files, machine_code, native
from modal.compiler.arithmetic import Untranslatable
from modal.compiler.folder import CacheWarning, obstacle
from modal.compiler.kinds import Number, NumberRow, Procedure, Row, Stack, Table, Three, Whole, WholeRow
from modal.compiler.lanes import LANES, choose, in_lanes

LEVEL = 3


def classified(x: float, least: int, strict: bool) -> int:
    """Branches, conditions that are looked at in turn, whole numbers and bits."""
    if (x < 0.0 and not strict) or x in (5.0, 7.0):
        return -1
    while least < 10:
        least += 1
        if least % 3 == 0:
            continue
        if least > x:
            break
    first = least // 2 if strict else 2 * least
    return min(max(first, LEVEL, int(x)), 17) + strict


def shared(a: float, b: float) -> Three:
    return a + b, a - b, a**3 / b if b != 0.0 else math.inf


def worked(x: float, row: Row, table: Table, stack: Stack, whole: Whole) -> float:
    """Parts of arrays, exchanges, tuples, loops up and down, functions."""
    part, first = table[1:], stack[1, 0]
    total, other = 0.0, row[0]
    for i in range(part.shape[0]):
        for j in range(part.shape[1] - 1, -1, -1):
            total += part[i, j] * first[j]
    row[0], row[1] = row[1], row[0]
    p, q, r = shared(total, other)
    row[2] = p - q * r
    row[1:][1] += 1.0
    size = np.sqrt(abs(total)) + np.log1p(x) + np.expm1(x) + np.tanh(x) + np.cosh(x) + x**0.7 + x**4
    for i in range(1, whole.shape[0]):
        size -= whole[i, 0] * (np.sin(x) if i == 1 else np.cos(x)) + np.ceil(x) - np.exp(-x) * np.log(x + 1.0)
    if not np.isfinite(r) or 0.0 < x < 1e-9:
        return -size
    return size + row.size


def slices(table: Table, out: Row) -> None:
    inner = table[2, 1:3]
    out[0], out[1], out[2] = inner[0], -inner[1], inner.size


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.setattr(machine_code, "cache_folder", lambda: tmp_path / "cache")
    monkeypatch.setattr(files, "_said", [])
    return tmp_path / "cache"


def test_branches_and_whole_numbers_are_those_of_python(folder):
    (compiled,) = native.native("classified", classified)
    for x in (-3.0, -0.0, 0.5, 4.0, 5.0, 6.2, 7.0, 12.9, math.inf, math.nan):
        for least in (0, 2, 9, 30):
            for strict in (False, True):
                if math.isfinite(x):
                    assert compiled(x, least, strict) == classified(x, least, strict)


def test_arrays_and_functions_are_those_of_python(folder):
    del folder
    random = np.random.default_rng(4)
    compiled, exchanged = native.native("worked", worked, slices)
    for x in (0.0, 1e-10, 0.3, 2.5):
        row, table = random.normal(size=4), random.normal(size=(3, 3))
        stack, whole = random.normal(size=(2, 2, 3)), random.integers(-5, 5, size=(3, 2))
        again = row.copy()
        wanted, got = worked(x, row, table, stack, whole), compiled(x, again, table, stack, whole)
        assert got == pytest.approx(wanted, rel=1e-14)
        assert again.tolist() == pytest.approx(row.tolist(), rel=1e-15)
    out = np.zeros(3)
    exchanged(table, out)
    assert out.tolist() == [table[2, 1], -table[2, 2], 2.0]


def test_a_function_that_an_earlier_one_calls_has_its_own_door(folder):
    del folder
    outer, inner = native.native("doors", _outer, _inner)
    assert (outer(2.0), inner(2.0)) == (7.0, 6.0)


def _outer(x: float) -> float:
    return _inner(x) + 1.0


def _inner(x: float) -> float:
    return 3.0 * x


def test_numbers_of_the_machine_do_not_fail(folder):
    del folder
    (quotient,) = native.native("quotient", _quotient)
    assert quotient(1.0, 0.0) == math.inf
    assert math.isnan(quotient(0.0, 0.0))


def _quotient(a: float, b: float) -> float:
    return a / b


@pytest.mark.parametrize(
    "table", [np.zeros((3, 3), dtype=np.float32), np.zeros(9), np.zeros((3, 3)).T[:, :2], np.zeros((4, 6))[:, ::2]]
)
def test_an_array_of_another_kind_is_refused(folder, table):
    del folder
    (compiled,) = native.native("slices", slices)
    with pytest.raises(TypeError, match="slices: table: wanted float64 in order, 2 axes, got"):
        compiled(table, np.zeros(2))


def _listed(x: float) -> float:
    return sum([x, x])


def _changes_kind(x: float) -> float:
    kept = 1
    kept = x
    return kept + x


def _attribute(x: float) -> float:
    return x.real


def _strides(row: Row) -> float:
    part = row[::2]
    return part[0]


@pytest.mark.parametrize("function", [_listed, _changes_kind, _attribute, _strides])
def test_what_cannot_be_compiled_is_refused_by_name(folder, function):
    del folder
    (compiled,) = native.native("refused", function)
    with pytest.raises((Untranslatable, AttributeError), match=function.__name__):
        compiled(np.zeros(3) if function is _strides else 1.0)


class Pair(NamedTuple):
    """What goes together."""

    row: Row
    counts: WholeRow


def squared(x: Number, row: NumberRow, out: NumberRow) -> Number:
    total: Number = 0.0
    for i in range(row.size):
        total += min(row[i] * x, 4.0)
        out[i] = -abs(row[i])
    return np.sqrt(max(total, 0.25))


def _handed(procedure: Procedure, pair: Pair, lanes: Table, out: Table, clock: Table) -> int:
    """Numbers and lane vectors by the same function, named tuples, bits, truth of numbers, rounding."""
    row, many, found = pair.row, in_lanes(lanes), in_lanes(out)
    counts, at = pair.counts, 0
    for lane in range(LANES):
        if lane >> 1 & 1 or (counts[0] and not row[0]):
            at |= 1 << lane
    found[0] = squared(2.0, many, found)
    found[1] = choose(in_lanes(clock)[0], found[0], 7.0)
    clock[0, 0] = squared(row[1], row, row)
    procedure(clock[0, 0], row, found)
    counts[1] = round(2.5) + round(3.5) + bool(at) + np.isinf(row[2]) + len_of(pair)
    return at


def len_of(pair: Pair) -> int:
    return pair.row.size


class Handed:
    """A procedure with the arguments that it is called with: the first entries of arrays, without their lengths."""

    def __init__(self):
        kind = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p, ctypes.c_void_p)
        self.given = []
        self._kept = kind(lambda *own: self.given.append(own))
        self.address = ctypes.cast(self._kept, ctypes.c_void_p).value


def test_lane_vectors_named_tuples_and_procedures(folder):
    del folder
    (compiled,) = native.native("handed", _handed)
    random = np.random.default_rng(9)
    lanes, out, clock = random.normal(size=(2, LANES)), np.zeros((3, LANES)), random.integers(0, 2, (1, LANES)) * 1.0
    wanted = clock[0].copy()
    pair, procedure = Pair(np.array([0.0, 3.0, -np.inf]), np.array([1, 0])), Handed()
    assert compiled(procedure, pair, lanes, out, clock) == 0xFF
    for lane in range(LANES):
        # Written after the function, which writes into the same rows.
        single = squared(2.0, lanes[:, lane], np.zeros(2))
        assert out[0, lane] == single
        assert out[1, lane] == (single if wanted[lane] else 7.0)
    assert procedure.given == [(0.5, pair.row.ctypes.data, out.ctypes.data)]
    assert pair.counts.tolist() == [1, 2 + 4 + 1 + 1 + 3]
    assert pair.row.tolist() == [-0.0, -3.0, -np.inf]
    pair.counts[0] = 0
    assert compiled(procedure, pair, lanes, out, clock) == 0b11001100


def emptied(_):
    return b""


def cut(code):
    return code[:-1]


def one_bit_flipped(code):
    return code[:100] + bytes([code[100] ^ 1]) + code[101:]


@pytest.mark.parametrize("damage", [emptied, cut, one_bit_flipped])
def test_damaged_code_is_made_anew_and_said(folder, damage):
    assert native.native("doors", _outer)[0](1.0) == 4.0
    (path,) = folder.rglob("doors.*.o")
    whole = path.read_bytes()
    path.write_bytes(damage(whole))
    with pytest.warns(CacheWarning, match="damaged machine code in .* is compiled anew"):
        assert native.native("doors", _outer)[0](1.0) == 4.0
    assert path.read_bytes() == whole


def test_threads_may_be_the_first_together(folder):
    del folder
    outer, _ = native.native("doors", _outer, _inner)
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(outer, [1.0] * 8)) == [4.0] * 8
    assert outer(2.0) == 7.0


def test_threads_that_are_the_first_together_load_one_engine(folder, monkeypatch):
    # A second one would free the machine code that another thread is in.
    del folder
    met, load, engines = Barrier(2, timeout=10.0), native._load, []

    def both(name, together):
        met.wait()
        load(name, together)

    monkeypatch.setattr(native, "_load", both)
    monkeypatch.setattr(native, "loaded", lambda *given: engines.append(machine_code.loaded(*given)) or engines[-1])
    (outer,) = native.native("doors", _outer)
    with ThreadPoolExecutor(2) as pool:
        assert list(pool.map(outer, [1.0, 2.0])) == [4.0, 7.0]
    assert len(engines) == 1


def test_code_from_disk_is_used_as_it_is(folder, monkeypatch):
    native.native("doors", _outer)[0](1.0)
    monkeypatch.setattr(machine_code, "_compiled", None)
    assert native.native("doors", _outer)[0](1.0) == 4.0


def test_a_folder_that_keeps_nothing_is_done_without_and_said(folder):
    folder.write_text("a file", encoding="utf-8")
    obstacle.cache_clear()
    with pytest.warns(CacheWarning, match="compiled each time"):
        assert native.native("doors", _outer)[0](1.0) == 4.0
