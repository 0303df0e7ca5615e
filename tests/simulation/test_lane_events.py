"""Runs in lanes whose equations switch or whose rates jump, beside single runs: the same bits."""

from dataclasses import dataclass, field, replace
from functools import cache
from types import MappingProxyType

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.qtz5613 import CRANE

from modal import Chain, EndBody, Segment
from towercrane import Load, load_case
from towercrane.cases.models import model_of, motions_of
from towercrane.cranes.tower.crane_model import tower_crane_model
from towercrane.cranes.tower.modes.collars import TowerCollar
from towercrane.cranes.tower.modes.mode_counts import ModeCounts
from towercrane.kernels.straight.leaves import CHANGING
from towercrane.motions.motion import phases, rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.observed import About, scalars
from towercrane.simulation.simulate import rows_of, simulate
from towercrane.simulation.system import System

LOOSE = {"rtol": 1e-6, "atol": 1e-8}
SECTIONS = Chain(
    (Segment(20.0, 250.0, 3e9, 1.5e8, 130.0), Segment(20.0, 180.0, 2e9, 1.2e8), Segment(15.6, 120.0, 8e8, 8e7)),
    {2: EndBody(400.0, 300.0)},
)


@cache
def jointed(load):
    """A crane with a jib of three sections, and a trolley that passes both joints, back over the outer one."""
    crane = replace(CRANE, jib=SECTIONS)
    model = tower_crane_model(crane, Load(load), ModeCounts(1, 0, 0, 2), planar=True)
    out, back = trapezoid(18.0, 42.0, 2.0, 0.6), trapezoid(42.0, 38.0, 1.0, 0.5)
    return model, {"trolley": sequence(out, back), "rope": rest(20.0)}


@cache
def held_with_play(load):
    """A crane whose tower a collar holds with play, pushed against it by the way of its trolley."""
    crane = replace(CRANE, gapped=(TowerCollar(12.0, 4e7, gap=1e-3 + 1e-6 * load),))
    model = tower_crane_model(crane, Load(load), ModeCounts(1, 0, 0, 1), planar=True)
    return model, {"trolley": trapezoid(10.0, 40.0, 2.0, 1.0), "rope": rest(20.0)}


STICKS = ["crane.friction.law=stick-slip", "crane.friction.torque=100 N m"]


@cache
def of_case(name, load, *changes):
    case = load_case(name, [f"payload.mass={load} kg", *changes])
    model = model_of(case)
    return model, motions_of(case, model)


def scenes(name):
    loads = (600.0, 1100.0, 2000.0)
    if name == "joints":
        return [jointed(load) for load in loads]
    if name == "collars with play":
        return [held_with_play(load) for load in loads]
    changes = STICKS if name.startswith("slewing/basic") else ()
    return [of_case(name, load, *changes) for load in loads]


@pytest.mark.parametrize(
    ("name", "duration"),
    [
        ("joints", 20.0),
        ("collars with play", 20.0),
        ("hard/friction-sticks", 12.0),
        ("qtz5613/soft-drive", 9.0),
        ("slewing/basic/example-1", 12.0),
    ],
)
def test_what_switches_or_jumps_does_so_in_lanes_as_in_a_single_run(name, duration):
    rows, runs = rows_of(duration, 0.05), []
    for model, motions in scenes(name):
        cut = phases(tuple(motions[channel] for channel in model.channels), duration)
        runs.append(LaneRun(model, cut))
        assert model.system.switch is not None or model.system.crossings.crosses(cut)
    found = integrate_many(runs, rows, threads=1, series=True, **LOOSE)
    for number, (model, motions) in enumerate(scenes(name)):
        single = simulate(model, motions, duration, **LOOSE)
        about = single.attrs
        assert found.outcomes[number] == about["outcome"] == "finished"
        assert found.evaluations[number] == about["evaluations"]
        assert (found.accepted[number], found.rejected[number]) == (about["steps_accepted"], about["steps_rejected"])
        assert np.array_equal(found.end_states[number], about["end_state"])
        for extremes, series, output in zip(
            found.extremes[number], found.series[number].T, scalars(model), strict=True
        ):
            values = single[output].values
            largest = max(np.max(abs(values)), 1e-300)
            assert_allclose(extremes[[0, 2]], [values.max(), values.min()], rtol=0, atol=1e-12 * largest)
            assert_allclose(series, values, rtol=0, atol=1e-12 * largest)


def test_a_guard_that_no_switch_knows_ends_a_run_in_its_lane_alone():
    model, motions = of_case("qtz5613/soft-drive", 600.0)
    falls = {**motions, "rope": sequence(rest(5.0, 2.0), trapezoid(5.0, 20.0, 8.0, 14.0))}
    stays = {**motions, "rope": rest(5.0)}
    runs = [
        LaneRun(model, phases(tuple(own[channel] for channel in model.channels), 4.0)) for own in (falls, stays)
    ]  # fmt: skip
    found = integrate_many(runs, rows_of(4.0, 0.05), threads=1, **LOOSE)
    assert found.outcomes == ["slack rope", "finished"]
    assert found.end_times[0] == simulate(model, falls, 4.0, **LOOSE).attrs["end_time"]


@dataclass(frozen=True)
class Spring:
    """Constants of a mass on a spring; the stiffness is another on either side."""

    stiffness: float = field(default=1.0, metadata=CHANGING)


@dataclass(frozen=True)
class Seen:
    crane: Spring
    offset: float = 2.0


def sprung(spring, t, y, inputs):
    place, speed, work = y
    return [speed, -spring.stiffness * place, 0.0 * work], [place]


class OtherSide:
    """Stiffens the spring when the mass comes to the other side."""

    changes_equations = True

    def begin(self, state, numbers, floors, guards_at):
        numbers[0], floors[0] = (1.0, 0.0) if state[0] >= 0.0 else (4.0, -np.inf)

    def cross(self, guard, state, numbers, floors, guards_at):
        numbers[0], floors[0] = 4.0, -np.inf
        return True


class SprungMass:
    """A model whose output tells the force that acts."""

    channels = ("unused",)
    seen = Seen(Spring())
    about = MappingProxyType({"force": About("N", "force of the spring")})
    system = System(sprung, 3, ("side",), np.zeros(1), np.ones(3), Spring(), switch=OtherSide())

    @staticmethod
    def outputs(seen, instant):
        return {"force": instant.slopes[1] + 0.0 * seen.offset}

    def start(self, inputs, state):
        return np.array([1.0, 0.0, 0.0])

    def provenance(self):
        return {}


def test_outputs_in_lanes_know_what_a_switch_has_changed():
    times = np.linspace(0.0, 2.3, 47)
    run = LaneRun(SprungMass(), phases((rest(0.0),), 2.3))
    found = integrate_many([run], times, threads=1, rtol=1e-10, atol=1e-12, series=True)
    # A quarter of a period at one, from then on at two radians a second.
    after = times - np.pi / 2
    wanted = np.where(after < 0.0, -np.cos(times), 4.0 * 0.5 * np.sin(2.0 * after))
    assert_allclose(found.series[0, :, 0], wanted, atol=1e-8)
