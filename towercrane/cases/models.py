"""The model and the motions that a case describes, for every kind of crane."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cranes.registry import KINDS
from towercrane.results.measures import picked_in

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

    from towercrane.cases.case import Case
    from towercrane.cranes.parts.poses import Poses
    from towercrane.motions.motion import Motion
    from towercrane.schema.targets import Targets
    from towercrane.simulation.system import Model


def model_of(case: Case, **changes: Any) -> Model:
    """Model of a case of any kind; keyword arguments replace what the case chose of its modes."""
    return KINDS[case.kind].build(case.checked, **changes)


def targets_of(case: Case) -> Targets:
    """Errors that a case asks for, by output; none for kinds of crane whose errors cannot be asked for."""
    targets = KINDS[case.kind].targets
    return targets(case.checked) if targets else {}


def motions_of(case: Case, model: Model | None = None) -> dict[str, Motion]:
    """What drives the crane, by channel; where a ramp is shaped for the model's frequencies, the model is asked.

    Parameters
    ----------
    case : Case
    model : Model, optional
        The case's own, where it has been built.

    Raises
    ------
    CaseError
        If the model has no such frequencies, because it buckles.
    """
    from towercrane.motions.plans import NotSettled, shaped_motions

    modelled = [channel for channel, plan in case.plans.items() if plan.needs_model]
    if not modelled:
        return shaped_motions(case.plans, None)
    from towercrane.cranes.tower.sway_frequencies import SwayFrequencies
    from towercrane.schema.faults import CaseError, Fault
    from towercrane.simulation.system import NoEquilibrium

    asked: Any = model or model_of(case)
    try:
        return shaped_motions(case.plans, SwayFrequencies(asked))
    except (NoEquilibrium, NotSettled) as failure:
        key = f"motion.{'hoist' if modelled[0] == 'rope' else modelled[0]}"
        wanted, hint = "frequencies that the model has, or a list of them", "towercrane modes shows what it has"
        raise CaseError([Fault(str(case.path), f"{key}.frequencies", wanted, str(failure), hint)]) from failure


def poses_of(case: Case, result: xr.Dataset, times: NDArray[np.float64], model: Model | None = None) -> Poses:
    """Poses of a run at any times within it.

    Between two rows of the result its coordinates are interpolated linearly; on a row they are the row's.

    Parameters
    ----------
    case : Case
        What was run.
    result : xarray.Dataset
    times : ndarray, shape (f,)
        [s]
    model : Model, optional
        The one that was run; that of a file is built in the modes that were picked for it.

    Raises
    ------
    ValueError
        If the result does not hold what the case's kind of crane needs.
    """
    kind = KINDS[case.kind]
    if model is None:
        picked = picked_in(result).items()
        model = model_of(case, **{key: count for key, count in picked if key.endswith("_modes")})
    return kind.poses(model, case.checked, result, times).below_hook(result)
