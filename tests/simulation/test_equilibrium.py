"""Static equilibrium where rounding ends the search."""

import pytest
from samples import lab_crane

from towercrane.motions.motion import phases, rest


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
