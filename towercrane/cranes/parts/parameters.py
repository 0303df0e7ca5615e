"""A crane's checked tables as parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from towercrane.schema.fields import Table


def flat(crane: Table) -> dict[str, Any]:
    """A crane's values by table and key, joined by an underscore."""
    found: dict[str, Any] = {}
    for name, value in crane.model_dump(exclude={"kind", "source"}).items():
        found |= (
            {f"{name}_{key}": inner for key, inner in value.items()} if isinstance(value, dict) else {name: value}
        )
    return found
