"""Where runs start: a start state follows its drives, a rope that is slack at the start is slack."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.every_kind import TURNED, lumped

from towercrane import load_case
from towercrane.motions.motion import phases, rest
from towercrane.runs.run import record_case
from towercrane.simulation.simulate import record
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

ANGLE = 1.0
TIMES = np.linspace(0.0, 4.0, 41)

ANGLES = {
    "shaft_angle", "slewing_angle", "platform_angle", "tower_angle", "jib_angle", "counter_jib_angle", "joint_angle",
}  # fmt: skip
VECTORS = {
    "wind": ("wind_x", "wind_y"),
    "moment": ("base_moment_x", "base_moment_y"),
    "force": ("base_force_x", "base_force_y"),
}


def as_if_turned(outputs: dict, angle: float) -> dict:
    """Outputs of the scene that begins at zero, as they are when all of it is turned by an angle."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    found = dict(outputs)
    for x, y in VECTORS.values():
        if x in found:
            found[x], found[y] = turn @ np.stack([outputs[x], outputs[y]])
    position = outputs["payload_position"].copy()
    position[:, :2] = position[:, :2] @ turn.T
    found["payload_position"] = position
    x, y = "tower_x_coordinate", "tower_y_coordinate"
    if x in found:
        found[x], found[y] = np.moveaxis(turn @ np.stack([outputs[x], outputs[y]], axis=1), 1, 0)
    for name in ANGLES & found.keys():
        shift = angle if outputs[name].ndim == 1 else angle * np.array([1.0, 0.0, 0.0])
        found[name] = outputs[name] + shift
    return found


@pytest.mark.parametrize("state", ["equilibrium", "zero"])
@pytest.mark.parametrize("kind", TURNED)
def test_a_scene_that_is_turned_runs_alike(kind, state):
    # A whole crane that is let fall has no tension at first, to rounding.
    (one, straight), (other, turned) = (TURNED[kind](angle).run(TIMES, 4.0, state=state) for angle in (0.0, ANGLE))
    assert one.outcome == other.outcome
    assert_allclose(other.end_time, one.end_time, rtol=1e-6)
    assert len(one.times) > 1
    for name, wanted in as_if_turned(straight, ANGLE).items():
        size = max(np.ptp(wanted, axis=0).max(), 1e-9 * np.max(abs(wanted)), 1e-3)
        assert_allclose(turned[name], wanted, rtol=0, atol=1e-5 * size, err_msg=name)


def test_the_drive_of_an_undeformed_crane_pulls_alike_wherever_it_begins():
    for start in ("0 rad", "1 rad", "-30 rad"):
        case = load_case("slewing/basic/example-1", [f"motion.shaft.start={start}", "start.state=zero"])
        assert abs(record_case(case)["drive_torque"].values).max() == pytest.approx(291.4, abs=0.05)


@pytest.mark.parametrize("kind", ["basic", "enhanced", "multi-mass"])
def test_an_undeformed_crane_stretches_nothing(kind):
    model = lumped(kind).model
    q = model.undeformed(phases((rest(2.0), rest(2.0)), 1.0).inputs[0])
    for spring in model.crane.springs:
        assert model.crane.row(spring.stretch)[:-1] @ q == pytest.approx(0.0, abs=1e-14)
    assert q[model.crane.coordinates.index(model.crane.drive.on)] == pytest.approx(2.0, rel=1e-14)


HOIST = (
    "motion.hoist.shape=speed-trapezoid", "motion.hoist.speed=-3 m/s", "motion.hoist.ramp=0.1s",
    "motion.hoist.hold=0.2s", "motion.hoist.delay=1s", "run.duration=4s",
)  # fmt: skip


@pytest.mark.parametrize(("kind", "earliest", "latest"), [("basic", 1.15, 1.16), ("enhanced", 1.263, 1.2632)])
def test_a_rope_goes_slack_whether_it_stretches_or_not(kind, earliest, latest):
    result = record_case(load_case(f"slewing/{kind}/example-1", HOIST))
    if kind == "basic":
        assert result.attrs["outcome"] == "finished"
        assert result.switches is not None
        end, forces = result.switches.times[0], result["hoist_rope_force"].values
        assert forces.min() == 0.0
    else:
        assert result.attrs["outcome"] == "slack rope"
        end, forces = result.attrs["end_time"], result["hoist_rope_force"].values[:-1]
        assert forces.min() > 0.0
    assert earliest < end < latest
    rod = record_case(load_case(f"slewing/{kind}/example-1", [*HOIST, "rope.slack=rod"]))
    assert rod.attrs["outcome"] == "finished"
    assert rod["hoist_rope_force"].values.min() < -100.0


@pytest.mark.parametrize("kind", ["enhanced", "multi-mass"])
def test_a_rope_above_the_horizontal_is_slack_from_the_start(kind):
    for angle, outcome in ((1.5, "finished"), (1.6, "slack rope"), (3.0, "slack rope")):
        motions = {"shaft": rest(0.3), "rope": rest(2.0)}
        result = record(lumped(kind).model, motions, 0.05, start=Start(along=angle))
        assert (result.attrs["outcome"], result.attrs["end_time"]) == (
            outcome,
            0.05 if outcome == "finished" else 0.0,
        )


def test_a_rope_that_stretches_starts_by_the_part_of_the_weight_along_it():
    model = lumped("basic").model
    inputs = phases((rest(0.0), rest(2.0)), 1.0).inputs[0]
    for angle in (0.0, 0.7, -1.2):
        start = begin(model, inputs, Start("equilibrium", along=angle))
        stretch = model.load.mass * model.crane.gravity * np.cos(angle) / model.crane.rope.spring(2.0)
        n = model.coordinates
        reach = np.linalg.norm(start[n : n + 3] - model.suspended(start, inputs).place)
        assert reach - 2.0 == pytest.approx(stretch, rel=1e-11)
