"""Keys of a rope that stretches and of the ground: each slip is one message."""

import numpy as np
import pytest

from towercrane.cases.case import CaseError, load_case
from towercrane.cases.models import model_of

LIFT, PLAIN, BASIC = "qtz5613/lift-off", "qtz5613/condition-3", "slewing/basic/example-1"


@pytest.mark.parametrize(
    ("name", "change", "key", "wanted"),
    [
        (PLAIN, ["rope.stiffness=14 MN/m"], "rope.stiffness", "a force"),
        (PLAIN, ["rope.stiffness=-1"], "rope.stiffness", "above 0"),
        (PLAIN, ["rope.stiffness=14"], "rope.stiffness", "a value from 1000"),
        (PLAIN, ["rope.stifness=14 MN"], "rope.stifness", "one of the keys"),
        (PLAIN, ["rope.extra_length=3 m"], "rope.extra_length", "a key beside stiffness"),
        (PLAIN, ["rope.stiffness=14 MN", "rope.axial_stiffness=7 MN"], "rope.axial_stiffness", "no key beside"),
        (PLAIN, ["rope.stiffness=14 MN", "rope.falls=2"], "rope.falls", "no key beside stiffness"),
        (PLAIN, ["rope.stiffness=14 MN", "rope.slack=stop"], "rope.slack", "no key of a rope that stretches"),
        (PLAIN, ["rope.stiffness=14 MN", "solver.method=scipy-radau"], "solver.method", "with an elastic rope"),
        (PLAIN, ["rope.stiffness=14 MN", "accuracy.target=1e-3"], "accuracy.target", "no error to ask for"),
        (PLAIN, ["ground.height=1 m"], "ground", "a rope that stretches"),
        (BASIC, ["rope.stiffness=1 MN"], "rope.stiffness", "no key here"),
        (LIFT, ["rope.damping_ratio=0.03"], "rope.damping_ratio", "no key beside relaxation_time"),
        (LIFT, ["rope.falls=0"], "rope.falls", "a whole number from 1"),
        (LIFT, ["rope.slack=rod"], "ground", "goes slack"),
        (LIFT, ["start.slack=20 m"], "start.slack", "less than rope.length"),
        (LIFT, ["start.slack=-5 mm"], "start.slack", "from 0"),
        (LIFT, ["start.state=zero"], "start.slack", "a crane in equilibrium"),
        (LIFT, ["ground.height=3 m"], "ground.height", "no key beside start.slack"),
        (LIFT, ["ground.friction=30"], "ground.friction", "a value from"),
        (LIFT, ["ground.frction=0.3"], "ground.frction", "one of the keys height, friction"),
    ],
)
def test_a_slip_is_one_fault_with_its_key(name, change, key, wanted):
    with pytest.raises(CaseError) as caught:
        load_case(name, change)
    (fault,) = caught.value.faults
    assert (fault.key, wanted in fault.wanted) == (key, True), fault


def test_a_rope_is_the_same_by_all_its_falls_or_by_one_and_by_time_or_by_ratio():
    more = ["rope.extra_length=32.5 m", "payload.mass=1500 kg"]
    whole, single = (
        model_of(load_case(PLAIN, [*more, *own])).load.elasticity
        for own in (
            ["rope.stiffness=14 MN", "rope.damping_ratio=0.02"],
            ["rope.axial_stiffness=7 MN", "rope.falls=2", "rope.relaxation_time=3 ms"],
        )
    )
    assert (whole.stiffness, whole.extra_length) == (single.stiffness, single.extra_length) == (14e6, 32.5)
    assert whole.relaxation_time == pytest.approx(0.04 / np.sqrt(14e6 / 50.5 / 1500.0), rel=1e-14)
    assert single.relaxation_time == 3e-3
