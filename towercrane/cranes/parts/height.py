"""Heights that a case's tables give before they are checked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.schema.ranges import si_at

if TYPE_CHECKING:
    from collections.abc import Callable


def summed(*keys: str) -> Callable[[dict[str, Any]], float | None]:
    """Sum of lengths of a case as written [m]; None where one is not known."""

    def height(tree: dict[str, Any]) -> float | None:
        parts = [si_at(tree, key, "m") for key in keys]
        # A post without height only says that its source gives none: heights count from its top.
        if any(part is None or part < 0.0 for part in parts) or not parts[0]:
            return None
        return sum(part for part in parts if part is not None)

    return height
