"""The table [accuracy] of a case: the error that is asked for."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from towercrane.accuracy import Tolerance
from towercrane.faults import did_you_mean, shown
from towercrane.nodes import OUTPUTS
from towercrane.schema import Table, ToleranceIfAny, refusal
from towercrane.units import UnitError, split, to_si

UNITS = dict(zip(OUTPUTS, ("m", "m", "rad", "N"), strict=True))
"""Unit of each output."""

LARGEST = 0.5
"""Error over an output's peak that may be asked for, at most."""

WANTED = (
    f'an error over the peak above 0 to {LARGEST:g}, such as 1e-3 or "0.1 %", an error with a unit, such as '
    '"0.1 mm", or a table with one per output'
)

Targets = dict[str, Tolerance]
"""Tolerance by output."""


class TargetField:
    """Annotation of the field that takes a target, alone or by output."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(read)


class OutputsField:
    """Annotation of the field that takes names of outputs."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(names)


def names(value: object) -> tuple[str, ...]:
    """Names of outputs."""
    wanted = f"a list of some of {', '.join(OUTPUTS)}"
    if not isinstance(value, list | tuple) or not value:
        raise refusal(wanted, shown(value), "")
    for name in value:
        if name not in OUTPUTS:
            raise refusal(wanted, shown(name), did_you_mean(str(name), OUTPUTS))
    return tuple(value)


def read(value: object) -> Targets:
    """Tolerances by output; one for all of its dimension where none is named."""
    if not isinstance(value, dict):
        return {name: found for name in OUTPUTS if (found := _tolerance(value, name)) is not None} or _nothing(value)
    targets: Targets = {}
    for name, inner in value.items():
        if name not in OUTPUTS:
            hint = did_you_mean(str(name), OUTPUTS)
            raise refusal(f"one of the outputs {', '.join(OUTPUTS)}", f'the unknown output "{name}"', hint)
        found = _tolerance(inner, name)
        if found is None:
            raise refusal(f"an error of {name} in {UNITS[name]} or over its peak", shown(inner), "")
        targets[name] = found
    return targets or _nothing(value)


def _tolerance(value: object, output: str) -> Tolerance | None:
    """Tolerance for an output, or None for a quantity of another dimension."""
    try:
        relative, unit = to_si(value, "1"), "1"
    except UnitError:
        relative, unit = 0.0, UNITS[output]
    try:
        number = relative if unit == "1" else to_si(value, unit)
    except UnitError as error:
        if isinstance(value, str) and any(_fits(value, other) for other in UNITS.values()):
            return None
        raise refusal(WANTED, shown(value), error.hint) from None
    if not number > 0.0 or (unit == "1" and number > LARGEST):
        hint = f"{100 * LARGEST:g} % of the peak at most" if number > 0.0 else ""
        raise refusal(WANTED, shown(value), hint)
    return Tolerance(number, relative=unit == "1")


def _fits(value: str, unit: str) -> bool:
    try:
        to_si(value, unit)
    except UnitError:
        return False
    return bool(split(value)[1])


def _nothing(value: object) -> Targets:
    raise refusal(WANTED, shown(value), "")


class Accuracy(Table):
    """Errors that are asked for: of frequencies, relative; of a run's outputs, without a list all with a target."""

    frequency: ToleranceIfAny = None
    target: Annotated[Targets, TargetField()] | None = None
    outputs: Annotated[tuple[str, ...], OutputsField()] = ()

    @model_validator(mode="after")
    def _every_output_has_a_target(self) -> Accuracy:
        if missing := [name for name in self.outputs if name not in (self.target or {})]:
            raise refusal("a target that fits every output", f"none for {', '.join(missing)}", "")
        return self

    @property
    def targets(self) -> Targets:
        """Tolerance of every output that is asked for; empty without a target."""
        target = self.target or {}
        return {name: target[name] for name in self.outputs} if self.outputs else target
