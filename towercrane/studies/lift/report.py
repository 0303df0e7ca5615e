"""What is told of a study of lift-off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from towercrane.cases.assumptions import as_entries, rests_on
from towercrane.simulation.outcomes import FINISHED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from towercrane.cases.case import Case
    from towercrane.studies.lift.hand import Classes
    from towercrane.studies.lift.hoisting import Hoisting
    from towercrane.studies.lift.place import Place


def report(
    case: Case, model: Any, places: list[Place], speeds: Sequence[float], found: list[dict[str, Any]], way: Hoisting,
    window: float, told: Classes,
) -> dict[str, Any]:  # fmt: skip
    """Ready for JSON."""
    damping = {
        name: value for name, value in getattr(case.checked, "model", ()) if name.endswith("_damping_ratio") and value
    }
    ended = [row for row in found if row["outcome"] != FINISHED or row["lift_off_s"] is None]
    notices = [
        f"at {row['trolley_position_m']:g} m and {row['speed_m_s']:g} m/s: "
        + (row["outcome"] if row["outcome"] != FINISHED else "the load was not lifted off")
        for row in ended
    ]
    passed = [
        row for row in found if row["dynamic_factor"] and row["dynamic_factor"]["rope"]["value"] > row["by_hand"]["k"]
    ]
    notices += [
        f"at {row['trolley_position_m']:g} m and {row['speed_m_s']:g} m/s the rope's factor passes that of k: "
        + (
            "the ramp after creeping is not in it"
            if row["speed_m_s"] > way.at_lift_off(row["speed_m_s"])
            else "no bound"
        )
        for row in passed
    ]
    return {
        "title": case.title,
        "crane": case.crane.name,
        "payload_kg": model.load.mass,
        "gravity_m_s2": model.crane.gravity,
        "rope_length_m": case.rope.length,
        "rope_spring_n_m": places[0].yielding.spring,
        "rope_relaxation_time_s": model.load.elasticity.relaxation_time,
        "structural_damping": damping,
        "window_s": window,
        "slack_m": way.slack,
        "acceleration_m_s2": way.acceleration,
        "creep_m_s": way.creep,
        "speeds_m_s": list(speeds),
        "standard": told.standard,
        "hoisting_classes": {
            name: {"phi2min": own.least, "beta2_s_m": own.slope} for name, own in told.by_name.items()
        },
        "positions": [
            {
                "trolley_position_m": place.position,
                "compliance_m_n": place.yielding.compliance,
                "k_eff_n_m": place.yielding.together,
                "compliance_times_k": place.yielding.compliance * place.yielding.spring,
                "by_hand_with": place.yielding.recommended,
            }
            for place in places
        ],
        "runs": found,
        "notices": notices,
        "assumed": as_entries(rests_on(case)),
    }
