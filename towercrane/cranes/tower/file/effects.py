"""What shear, weight, rotary inertia and foundation matter for a case, and which of them its tolerance keeps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from math import isinf
from typing import TYPE_CHECKING, Any

import numpy as np

from modal import Beam, Chain, chain_frequencies, chain_structure
from modal.structures.influence import EFFECTS, Effect, Influence, effects_of, influence, keeping
from modal.structures.members import Unstable
from modal.structures.structure_modes import structure_modes
from towercrane.cranes.tower.file.members import crane_on, laced_column, tower_of, with_end_body
from towercrane.cranes.tower.modes.parameters import as_chain

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from towercrane.cranes.tower.file.case_tables import TowerCase
    from towercrane.cranes.tower.file.tables import Crane

    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Effects:
    """Effects on the frequencies of a case's tower with the slewing part on its end.

    Parameters
    ----------
    tower : Chain
        The tower with everything that is known of it, slewing part and weight included.
    above : float
        Mass of trolley and load, which weigh on it too [kg].
    plain_frequencies : ndarray, shape (n,)
        Angular frequencies without any effect [rad/s].
    influence : Influence
        Predicted changes by each effect that is known.
    kept : tuple of str
        Effects that the case's results include.
    tolerance : float, optional
        Relative error of frequencies that the case accepts [1].
    """

    tower: Chain
    above: float
    plain_frequencies: Floats
    influence: Influence
    kept: tuple[Effect, ...]
    tolerance: float | None

    @property
    def left_out(self) -> tuple[Effect, ...]:
        """Effects that are known, but not in the case's results."""
        return tuple(effect for effect in self.influence.changes if effect not in self.kept)

    @property
    def results_tower(self) -> Chain:
        """The tower with the slewing part on its end and what the results include; its weight with all above it."""
        return self.with_effects(self.kept)

    def with_effects(self, effects: Collection[Effect]) -> Chain:
        """The tower with no more than the given effects, trolley and load upon it."""
        only = keeping(self.tower, effects)
        return replace(only, axial_load=only.axial_load + only.gravity * self.above)

    def actual(self, effect: Effect) -> Floats:
        """Change of the frequencies by one effect alone, solved [1], shape (n,)."""
        return self.change((), (effect,))

    def change(self, before: Collection[Effect], after: Collection[Effect]) -> Floats:
        """Change of the frequencies from some effects to others, solved [1], shape (n,); -1 where a tower buckles."""
        if set(before) == set(after):
            return np.zeros_like(self.plain_frequencies)
        try:
            return self._solved(after) / self._solved(before) - 1.0
        except Unstable:
            return -np.ones_like(self.plain_frequencies)

    def _solved(self, effects: Collection[Effect]) -> Floats:
        return chain_frequencies(self.with_effects(effects), self.plain_frequencies.size)


def effects_in(tables: TowerCase) -> Effects:
    """Effects known of a case's tower, how much each is predicted to matter, and those that are kept.

    Without ``accuracy.frequency`` the results hold what the case describes, and the weight's softening where
    ``model.weight_softening`` asks for it. With it, of those and the weight, what is negligible is left out. Each
    effect is predicted alone, from modes without the others: the frequencies without what is left out are solved
    beside those with it, and what a prediction cannot vouch for stays in.
    """
    model, tolerance = tables.model, tables.accuracy.frequency
    asked = "weight_softening" in model.model_fields_set
    hung = tables.payload.mass + (0.0 if tables.hook is None else tables.hook.mass)
    return _effects(tables.crane, hung, tables.modes.count, model.weight_softening, asked, tolerance)


@lru_cache(maxsize=8)
def _effects(
    crane: Crane, payload_mass: float, count: int, softened: bool, asked: bool, tolerance: float | None
) -> Effects:
    """Effects of a crane's tower in so many modes; whether the weight softens it may be asked for or a default."""
    written = tower_of(crane)
    described, head = as_chain(written), crane_on(written, crane).end_body
    known = replace(with_end_body(_with_lattice(crane, described), head), gravity=crane.gravity)
    above = crane.trolley.mass + payload_mass
    plain = structure_modes(chain_structure(keeping(known, ())), count)
    found = influence(plain, known, above)
    of_the_case = set(effects_of(described))
    if softened or (tolerance is not None and not asked):
        of_the_case.add("weight")
    kept = tuple(effect for effect in EFFECTS if effect in of_the_case)
    effects = Effects(known, above, plain.angular_frequencies, found, kept, tolerance)
    if tolerance is None:
        return effects
    fixed = ("weight",) if softened else ()
    negligible = Influence({effect: found.changes[effect] for effect in kept}).negligible(tolerance)
    left_out = [effect for effect in negligible if effect not in fixed]

    def without() -> tuple[Effect, ...]:
        return tuple(effect for effect in kept if effect not in left_out)

    while left_out and np.abs(effects.change(kept, without())).max() > tolerance:
        left_out.pop()
    return replace(effects, kept=without())


def softened(tables: TowerCase) -> bool:
    """Whether the weight softens the tower in a case's results: as it says, or by its tolerance."""
    if tables.accuracy.frequency is None:
        return tables.model.weight_softening
    return "weight" in effects_in(tables).kept


def kept_tower(tables: TowerCase) -> Beam | Chain:
    """The tower of a case, without the slewing part and without weight, as the case's tolerance keeps it."""
    tower = tower_of(tables.crane)
    if isinstance(tower, Beam) or tables.accuracy.frequency is None:
        return tower
    return keeping(tower, effects_in(tables).kept)


def _with_lattice(crane: Crane, tower: Chain) -> Chain:
    """The tower with what shears and turns in a lattice that stands beside its stated beam."""
    segment, *others = tower.segments
    lattice, modulus = crane.tower.lattice, crane.tower.youngs_modulus
    if others or lattice is None or modulus is None:
        return tower
    laced = laced_column(lattice, modulus).segment(segment.length, segment.mass_per_length)
    shear = laced.shear_stiffness if isinf(segment.shear_stiffness) else segment.shear_stiffness
    rotary = segment.rotary_inertia or laced.rotary_inertia
    known = replace(segment, shear_stiffness=shear, rotary_inertia=rotary, mass_flexibility=laced.mass_flexibility)
    return replace(tower, segments=(known,))


def effects_report(effects: Effects, *, actual: bool = False) -> dict[str, Any]:
    """Effects ready for JSON.

    Parameters
    ----------
    effects : Effects
    actual : bool
        Solve for the actual change by each effect as well.

    Returns
    -------
    dict
        ``tolerance``, ``kept``, ``left_out``, ``left_out_may_cost`` (largest relative change of a frequency, the sum
        of the predictions or what is solved for all at once, whichever is more) and ``changes`` by effect:
        ``predicted`` and, where asked for, ``actual``, one per mode.
    """
    found = effects.influence
    rows: dict[str, dict[str, list[float]]] = {}
    for effect, change in found.changes.items():
        rows[effect] = {"predicted": change.tolist()}
        if actual:
            rows[effect]["actual"] = effects.actual(effect).tolist()
    predicted = sum((np.abs(found.changes[effect]) for effect in effects.left_out), np.zeros(1))
    solved = np.abs(effects.change(effects.kept, tuple(found.changes)))
    return {
        "tolerance": effects.tolerance,
        "kept": list(effects.kept),
        "left_out": list(effects.left_out),
        "left_out_may_cost": float(max(predicted.max(), solved.max())),
        "changes": rows,
    }
