"""All methods by name."""

from __future__ import annotations

from typing import TypeVar

from towercrane.simulation.methods.method import Method
from towercrane.simulation.methods.runge_kutta import RungeKutta
from towercrane.simulation.methods.scipy_methods import SCIPY_METHODS
from towercrane.simulation.methods.tableaus import DOP853, DOPRI5

Kind = TypeVar("Kind", bound=Method)

METHODS: dict[str, Method] = {method.name: method for method in (DOP853, DOPRI5, *SCIPY_METHODS)}
"""What a case may name. A further method is one more entry."""


def method_of(name: str) -> Method:
    """The method of a name.

    Raises
    ------
    ValueError
        If there is none.
    """
    return _one_of(METHODS, name)


def pair_of(name: str) -> RungeKutta:
    """The Runge-Kutta pair of a name: many runs side by side take no other method.

    Raises
    ------
    ValueError
        If there is none.
    """
    return _one_of({own: method for own, method in METHODS.items() if isinstance(method, RungeKutta)}, name)


def _one_of(methods: dict[str, Kind], name: str) -> Kind:
    # Whatever is asked for, even what no key can be.
    if not isinstance(name, str) or name not in methods:
        raise ValueError(f"method: wanted one of {', '.join(methods)}, got {name!r}")
    return methods[name]
