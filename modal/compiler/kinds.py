"""Arrays and tuples that compiled functions take, see `modal.compiler.translation`."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

Row = Annotated[NDArray[np.float64], "double", 1]
Table = Annotated[NDArray[np.float64], "double", 2]
Stack = Annotated[NDArray[np.float64], "double", 3]
Whole = Annotated[NDArray[np.int64], "whole", 2]
"""Contiguous arrays of one, two and three axes; of whole numbers with two."""

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
"""Numbers that go together."""
