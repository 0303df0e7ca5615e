"""Static equilibrium where rounding ends the search, and where the whole of the forces leads astray."""

import numpy as np
import pytest
from samples import lab_crane

from towercrane.cases.case import load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.motions.motion import phases, rest
from towercrane.simulation.equilibrium import Unstable, stable_equilibrium
from towercrane.simulation.system import NoEquilibrium


@pytest.mark.parametrize(
    ("soft", "stiff", "error"),
    [(1.0, 1e4, 1e-11), (1e-2, 1e4, 1e-9), (1e-2, 1e5, 5e-9), (1e-1, 1e5, 1e-9), (1e-3, 1e7, 5e-7)],
)
def test_a_stiff_crane_on_a_soft_drive_settles(soft, stiff, error):
    springs = {name: stiff for name in vars(lab_crane.MULTI_MASS) if name.startswith("stiffness")}
    model = lab_crane.crane("multi-mass", drive_soft_stiffness=soft, **springs)
    found = model.equilibrium(phases((rest(0.3), rest(2.0)), 1.0).inputs[0])
    # Nothing turns it: the platform stands where the shaft does.
    assert abs(found[model.crane.coordinates.index("platform_angle")] - 0.3) < error
    vertical = found[model.crane.coordinates.index("jib_vertical")]
    assert vertical == pytest.approx(-64.5 * 9.81 / stiff, rel=1e-9)


def _soft_at_first(load):
    """Force on a spring that is soft at first, then stiff, and gives way beyond 1.03."""
    return lambda q: load - (0.2 * q + 3.0 * q**2 - 2.0 * q**3)


@pytest.mark.parametrize("found", [0.05, 0.4, 0.8, 1.02])
def test_a_whole_load_that_leads_astray_is_put_on_in_parts(found):
    load = 0.2 * found + 3.0 * found**2 - 2.0 * found**3
    assert stable_equilibrium(_soft_at_first(load), np.ones(1)) == pytest.approx([found], rel=1e-12)


def test_a_load_that_no_part_of_the_way_carries_is_refused():
    with pytest.raises(Unstable):
        stable_equilibrium(_soft_at_first(1.21), np.ones(1))


def test_a_slender_jib_stands_on_its_ties_up_to_its_buckling_load():
    changes = ["motion.trolley.start=44 m", "motion.trolley.end=45 m", "run.duration=0.1 s"]
    for tonnes in (9.0, 12.5, 13.8):
        case = load_case("hard/near-buckling-on-ties", [*changes, f"payload.mass={tonnes} t"])
        model = model_of(case)
        motions = motions_of(case, model)
        inputs = phases(tuple(motions[name] for name in model.channels), 0.1).inputs[0]
        q = model.start(inputs)[: model.coordinates]
        assert np.max(abs(model.static_forces(q[:, None], inputs))) < 1e-4
    with pytest.raises(NoEquilibrium, match="ties press too hard") as refused:
        model_of(load_case("hard/near-buckling-on-ties", [*changes, "payload.mass=14.2 t"])).start(inputs)
    assert refused.value.outcome == "no stable equilibrium"
