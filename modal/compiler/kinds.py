"""Kinds of what compiled functions take, see `modal.compiler.translation`."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

Row = Annotated[NDArray[np.float64], "double", 1]
Table = Annotated[NDArray[np.float64], "double", 2]
Stack = Annotated[NDArray[np.float64], "double", 3]
Stacks = Annotated[NDArray[np.float64], "double", 4]
WholeRow = Annotated[NDArray[np.int64], "whole", 1]
Whole = Annotated[NDArray[np.int64], "whole", 2]
"""Contiguous arrays of one to four axes; of whole numbers with one and two."""

LaneRow = Annotated[Any, "lanes", 1]
LaneTable = Annotated[Any, "lanes", 2]
"""Contiguous arrays of lane vectors, see `modal.compiler.lanes`."""

Number = Annotated[Any, "number", 0]
NumberRow = Annotated[Any, "number", 1]
NumberTable = Annotated[Any, "number", 2]
"""A double or a lane vector, and arrays of such: in one call all of the same kind."""

Procedure = Annotated[Any, "procedure", 0]
"""A compiled function that takes numbers and arrays, of these their first entry alone, and gives nothing."""

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
"""Numbers that go together."""
