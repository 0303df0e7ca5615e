"""How much shear, weight, rotary inertia and foundation change a tower's frequencies, from its plain modes alone.

The plain tower is the Euler-Bernoulli beam, clamped, without weight. A mode of it carries a moment and a transverse
force whose energy in a spring that was left out, over the energy in bending, says what that spring would do to the
frequency (a Rayleigh quotient in the forces, which holds even where the change is large).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from modal.beams.beam import EndBody
from modal.beams.chain import Chain, Foundation
from modal.structures.part_shapes import FORCE, MOMENT, SLOPE

if TYPE_CHECKING:
    from collections.abc import Collection

    from numpy.typing import NDArray

    from modal.structures.structure_modes import StructureModes

    Floats = NDArray[np.float64]

Effect = Literal["shear", "weight", "rotary inertia", "foundation"]
EFFECTS: tuple[Effect, ...] = get_args(Effect)


def effects_of(tower: Chain) -> tuple[Effect, ...]:
    """What a tower has that its plain version has not."""
    present = {
        "shear": any(segment.shear_stiffness < inf for segment in tower.segments),
        "weight": bool(tower.gravity or tower.axial_load),
        "rotary inertia": any(segment.rotary_inertia > 0.0 for segment in tower.segments),
        "foundation": tower.foundation != Foundation(),
    }
    return tuple(effect for effect in EFFECTS if present[effect])


def keeping(tower: Chain, effects: Collection[Effect]) -> Chain:
    """The same tower with no more than the given effects."""
    segments = tower.segments
    if "shear" not in effects:
        segments = tuple(replace(segment, shear_stiffness=inf, mass_flexibility=0.0) for segment in segments)
    if "rotary inertia" not in effects:
        segments = tuple(replace(segment, rotary_inertia=0.0) for segment in segments)
    kept = replace(tower, segments=segments)
    if "weight" not in effects:
        kept = replace(kept, gravity=0.0, axial_load=0.0)
    if "foundation" not in effects:
        kept = replace(kept, foundation=Foundation())
    return kept


@dataclass(frozen=True, eq=False)
class Influence:
    """Predicted relative changes of n frequencies by each effect alone.

    Parameters
    ----------
    changes : dict of str to ndarray, shape (n,)
        By effect: relative change of the frequency [1], negative where it falls; -1 where the tower would buckle,
        or where a body at its foot vibrates on the springs below the frequency.
    """

    changes: dict[Effect, Floats]

    def together(self, effects: Collection[Effect]) -> Floats:
        """Change by several effects at once, each taken as if alone [1], shape (n,)."""
        kept = [1.0 + self.changes[effect] for effect in effects]
        return np.prod(kept, axis=0) - 1.0 if kept else np.zeros(len(next(iter(self.changes.values()), [])))

    def negligible(self, tolerance: float) -> tuple[Effect, ...]:
        """The effects that may be left out, least first, as long as all left out together stay below a tolerance."""
        chosen: list[Effect] = []
        by_size = sorted(self.changes, key=lambda effect: float(np.abs(self.changes[effect]).max()))
        for effect in by_size:
            if np.abs([self.changes[one] for one in (*chosen, effect)]).sum(axis=0).max() > tolerance:
                break
            chosen.append(effect)
        return tuple(chosen)


def influence(plain: StructureModes, tower: Chain, above: float = 0.0) -> Influence:
    """What the effects of a tower would do to frequencies, from modes found without them.

    Parameters
    ----------
    plain : StructureModes
        Modes of a structure whose part "tower" is ``keeping(tower, ())``.
    tower : Chain
        The same tower with all its effects.
    above : float
        Mass that weighs on the tower's end besides its own bodies [kg]: jib, trolley, payload.

    Returns
    -------
    Influence
        Frequency ratios ``(1 + U_x/U)^-1/2`` with ``U = omega^2`` times the modal mass and ``U_x = int (V + M b'/b)^2
        /S + c V'^2`` (shear, with the moment where chords are inclined and c where mass is moved from the axis),
        ``omega^2 int rho I v'^2`` (rotary inertia),
        ``f^T (K - omega^2 M)^-1 f`` with the force and moment ``f = (V(0), M(0))`` on the springs ``K`` under the
        foot and the inertia ``M`` of a body there (foundation);
        and ``(1 - U_g/U)^1/2`` with ``U_g = int N v'^2`` and the moment of bodies above their node (weight). Where
        the foot on its springs is slower than a mode, that mode is taken to be lost.
    """
    part = plain.parts["tower"]
    squared = plain.angular_frequencies**2
    changes: dict[Effect, Floats] = {}
    for effect in effects_of(tower):
        if effect == "weight":
            taken = _weight_energy(plain, replace(tower, axial_load=tower.axial_load + tower.gravity * above))
            changes[effect] = np.sqrt(np.maximum(1.0 - taken / squared, 0.0)) - 1.0
            continue
        if effect == "shear":
            # Inclined chords carry a part of the shear, M b'/b of the moment.
            strained = part.at_points(FORCE) + tower.incline(part.points) * part.at_points(MOMENT)
            energy = np.tensordot(strained**2, part.weights / tower.section(part.points, "shear_stiffness"), 2)
            energy += np.tensordot(part.inertia**2, part.weights * tower.section(part.points, "mass_flexibility"), 2)
        elif effect == "rotary inertia":
            energy = squared * part.energies(tower.section(part.points, "rotary_inertia"), SLOPE)
        else:
            forces = np.array([part.evaluate(0.0, FORCE), part.evaluate(0.0, MOMENT)])
            energy = _foundation_energy(tower, forces, squared)
        changes[effect] = 1.0 / np.sqrt(1.0 + energy / squared) - 1.0
    return Influence(changes)


def _foundation_energy(tower: Chain, forces: Floats, squared: Floats) -> Floats:
    """Twice the energy of each mode's forces, shape (2, n), in the springs under the foot and a body that they carry.

    Infinite where the body on its springs is slower than the mode.
    """
    foot, body = tower.foundation, tower.bodies.get(0, EndBody())
    moment = body.mass * body.offset
    inertia = np.array([[body.mass, moment], [moment, body.rotary_inertia + moment * body.offset]])
    springs = np.array([
        [foot.translation_stiffness, foot.coupling], [foot.coupling, foot.rotation_stiffness]
    ])  # fmt: skip
    # What is rigid does not move, whatever its inertia.
    free = np.flatnonzero(np.isfinite(np.diag(springs)))
    at = np.ix_(free, free)
    stiffness = springs[at] - squared[:, None, None] * inertia[at]
    energy = np.full(squared.shape, inf)
    stands = np.linalg.eigvalsh(stiffness)[:, 0] > 0.0
    acting = forces[free].T[stands, :, None]
    energy[stands] = np.sum(acting * np.linalg.solve(stiffness[stands], acting), axis=(1, 2))
    return energy


def _weight_energy(plain: StructureModes, tower: Chain) -> Floats:
    """Twice the potential energy that weight and axial load take from each mode."""
    part = plain.parts["tower"]
    taken = part.energies(tower.compression(part.points), SLOPE)
    for node, body in tower.bodies.items():
        taken += tower.gravity * body.mass * body.offset * part.evaluate(tower.nodes[node], SLOPE) ** 2
    return taken
