"""The table [accuracy] of a case: the error that is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Self

from pydantic import GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from towercrane.schema.faults import did_you_mean, shown
from towercrane.schema.fields import Table, refusal
from towercrane.schema.units import UnitError, split, to_si

if TYPE_CHECKING:
    from collections.abc import Iterable

LARGEST = 0.5
"""Error over an output's peak that may be asked for, at most."""

WANTED = (
    f'an error over the peak above 0 to {LARGEST:g}, such as 1e-3 or "0.1 %", an error with a unit, such as '
    '"0.1 mm", or a table with one per output'
)


class Tolerance(NamedTuple):
    """Error that is wanted of an output: over its peak, or in its unit."""

    value: float
    relative: bool


Targets = dict[str, Tolerance]
"""Tolerance by output."""


class ForEvery(Targets):
    """Tolerance of all outputs that one without a name fits."""


class TargetField:
    """Annotation of the field that takes a target, alone or by output.

    Parameters
    ----------
    units : dict of str to str
        Unit of each output that may have a target.
    every : iterable of str
        Outputs that a target has where none is named.
    """

    def __init__(self, units: dict[str, str], every: Iterable[str]) -> None:
        self.units, self.every = units, tuple(every)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.with_info_plain_validator_function(self.read)

    def read(self, value: object, info: core_schema.ValidationInfo) -> Targets:
        """Tolerances by output; where none is named one for all of its dimension, or for those in the list."""
        if not isinstance(value, dict):
            asked = info.data.get("outputs")
            fitting = {name: self._tolerance(value, name) for name in asked or self.every}
            targets = {name: found for name, found in fitting.items() if found is not None}
            if asked and len(targets) < len(asked):
                raise self._unfit(next(name for name in asked if name not in targets), value)
            return ForEvery(targets) if targets else _nothing(value)
        targets = {}
        for name, inner in value.items():
            if name not in self.units:
                hint = did_you_mean(str(name), self.units)
                raise refusal(f"one of the outputs {', '.join(self.units)}", f'the unknown output "{name}"', hint)
            found = self._tolerance(inner, name)
            if found is None:
                raise self._unfit(name, inner)
            targets[name] = found
        return targets or _nothing(value)

    def _tolerance(self, value: object, output: str) -> Tolerance | None:
        """Tolerance for an output, or None for a quantity that fits another."""
        unit = self.units[output]
        try:
            number, relative = to_si(value, "1"), True
        except UnitError:
            relative = False
        try:
            number = number if relative else to_si(value, unit)
        except UnitError as error:
            if isinstance(value, str) and any(_fits(value, other) for other in set(self.units.values())):
                return None
            raise refusal(WANTED, shown(value), error.hint) from None
        if not number > 0.0 or (relative and number > LARGEST):
            hint = f"{100 * LARGEST:g} % of the peak at most" if number > 0.0 else ""
            raise refusal(WANTED, shown(value), hint)
        return Tolerance(number, relative)

    def _unfit(self, output: str, value: object) -> PydanticCustomError:
        return refusal(f"an error of {output} in {self.units[output]} or over its peak", shown(value), "")


class OutputsField:
    """Annotation of the field that takes names of outputs.

    Parameters
    ----------
    known : iterable of str
    """

    def __init__(self, known: Iterable[str]) -> None:
        self.known = tuple(known)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.names)

    def names(self, value: object) -> tuple[str, ...]:
        """Names of outputs."""
        wanted = f"a list of some of {', '.join(self.known)}"
        if not isinstance(value, list | tuple) or not value:
            raise refusal(wanted, shown(value), "")
        for name in value:
            if name not in self.known:
                raise refusal(wanted, shown(name), did_you_mean(str(name), self.known))
        return tuple(value)


def _fits(value: str, unit: str) -> bool:
    try:
        to_si(value, unit)
    except UnitError:
        return False
    return bool(split(value)[1])


def _nothing(value: object) -> Targets:
    raise refusal(WANTED, shown(value), "")


class Asked(Table):
    """Errors that are asked for of a run's outputs."""

    outputs: tuple[str, ...] = ()
    target: Targets | None = None

    @model_validator(mode="after")
    def _every_output_has_a_target(self) -> Self:
        if missing := [name for name in self.outputs if name not in (self.target or {})]:
            raise refusal("a target that fits every output", f"none for {', '.join(missing)}", "")
        return self

    @property
    def targets(self) -> Targets:
        """Tolerance of every output that is asked for; empty without a target."""
        target = self.target or {}
        return {name: target[name] for name in self.outputs} if self.outputs else target
