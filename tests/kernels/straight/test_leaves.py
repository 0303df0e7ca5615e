"""Numbers of constants in a row and back, whatever the record is made of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from towercrane.kernels.straight.leaves import (
    CHANGING,
    changing,
    known_of,
    numbers_of,
    place_of,
    table_of,
    with_numbers,
)

Floats = Table = Any


@dataclass(frozen=True, slots=True)
class Part:
    mass: float
    name: str = "part"

    def __post_init__(self):
        if not self.mass > 0.0:
            raise ValueError("mass")


@dataclass(frozen=True)
class Whole:
    count: int
    length: float
    part: Part
    spare: Part | None
    rows: Floats
    state: float = field(metadata=CHANGING)
    shapes: Table = field(default_factory=lambda: np.ones((2, 1, 3)))


WHOLE = Whole(2, 3.0, Part(5.0), None, np.arange(6.0).reshape(2, 3), 7.0)


def test_numbers_stand_in_a_row_in_the_order_of_their_fields():
    assert numbers_of(WHOLE).tolist() == [3.0, 5.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0]
    assert [place_of(WHOLE, name) for name in ("length", "mass", "rows", "state")] == [0, 1, 2, 8]
    assert changing(WHOLE) == (8,)
    with pytest.raises(KeyError):
        place_of(WHOLE, "count")
    assert (numbers_of(None).size, table_of(None).shape, known_of(None), changing(None)) == (0, (0, 0, 0), None, ())


def test_a_record_with_other_numbers_keeps_all_else_and_checks_nothing():
    other = with_numbers(WHOLE, -numbers_of(WHOLE), "a table")
    assert (other.length, other.part.mass, other.part.name, other.count, other.shapes) == (
        -3.0,
        -5.0,
        "part",
        2,
        "a table",
    )
    assert other.rows.tolist() == (-WHOLE.rows).tolist()
    assert known_of(with_numbers(WHOLE, -numbers_of(WHOLE), WHOLE.shapes)) == known_of(WHOLE)


@pytest.mark.parametrize(
    "change", [{"count": 3}, {"spare": Part(1.0)}, {"part": Part(5.0, "other")}, {"rows": np.zeros(6)}]
)
def test_all_but_numbers_is_known(change):
    assert known_of(Whole(**(vars(WHOLE) | change))) != known_of(WHOLE)


@dataclass(frozen=True)
class Around:
    whole: Whole
    factor: float


def test_the_table_of_a_record_inside_another_is_found_and_exchanged():
    around = Around(WHOLE, 2.0)
    assert table_of(around) is WHOLE.shapes
    assert with_numbers(around, numbers_of(around), "a table").whole.shapes == "a table"


@dataclass(frozen=True)
class Careless:
    mass: float | None


def test_a_number_that_would_be_taken_for_known_is_refused():
    assert known_of(Careless(None)) == (Careless, None)
    with pytest.raises(TypeError, match="wanted a field of type float or Floats for a number"):
        known_of(Careless(2.0))
