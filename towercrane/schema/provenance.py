"""Where single values are from: assumed, or of a source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from towercrane.schema.faults import Fault, did_you_mean, shown

ABOUT = ("assumed", "source")
"""What may stand beside `value` in a table that says where a value is from."""


@dataclass(frozen=True, slots=True)
class Assumption:
    """A value that no source gives.

    Parameters
    ----------
    key : str
        Dotted key from the case's root.
    value : object
        The value as written.
    why : str
        Why this value was taken.
    """

    key: str
    value: object
    why: str


def split_provenance(tree: dict[str, Any]) -> tuple[dict[str, Any], list[Assumption], list[Fault]]:
    """Replace each table ``{value = ..., assumed = "why"}`` by its value; list assumptions, crane's first."""
    found: list[Assumption] = []
    faults: list[Fault] = []

    def plain(node: Any, key: str) -> Any:
        if isinstance(node, list):
            return [plain(item, f"{key}.{i}") for i, item in enumerate(node)]
        if not isinstance(node, dict):
            return node
        if "value" not in node:
            return {name: plain(item, f"{key}.{name}" if key else name) for name, item in node.items()}
        for name, why in node.items():
            if name != "value" and name not in ABOUT:
                hint = did_you_mean(name, ABOUT)
                got = f'the unknown key "{name}"'
                faults.append(Fault("", f"{key}.{name}", "beside value: assumed or source", got, hint))
            elif name in ABOUT and not (isinstance(why, str) and why.strip()):
                faults.append(Fault("", f"{key}.{name}", "a text that says why or where from", shown(why)))
            elif name == "assumed":
                found.append(Assumption(key, node["value"], why))
        return node["value"]

    result = plain(tree, "")
    found.sort(key=lambda a: not a.key.startswith("crane."))
    return (result if isinstance(result, dict) else {}), found, faults
