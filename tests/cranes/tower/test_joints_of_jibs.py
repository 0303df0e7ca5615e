"""A trolley that passes joints of its jib: against momenta, which pass them as they are, and by its energy."""

import dataclasses
from functools import cache

import numpy as np
import pytest
from oracles.momenta import Momenta
from samples import jointed_jib as jointed
from samples import sectioned_crane as sectioned
from samples import space_crane as space

from towercrane.motions.motion import Motion, phases, rest, sequence
from towercrane.motions.profiles import trapezoid
from towercrane.simulation.integrate import integrate
from towercrane.simulation.lanes.many import integrate_many
from towercrane.simulation.lanes.run import LaneRun
from towercrane.simulation.simulate import record
from towercrane.simulation.starts.begin import begin
from towercrane.simulation.starts.start import Start

END = 1.4
PLANES = pytest.mark.parametrize("planar", [True, False], ids=["in the plane", "in space"])
model = cache(jointed.model)

WAYS = {
    "out past five joints": (jointed.motions(True)["trolley"], 5),
    "from a joint outward": (trapezoid(10.0, 12.2, 1.5, 1.0), 3),
    "from a joint inward": (trapezoid(12.0, 9.0, 1.5, 1.0), 3),
    "to a joint": (trapezoid(9.0, 11.0, 1.0, 1.0), 2),
    "to a joint and back": (sequence(trapezoid(9.0, 11.0, 1.0, 1.0), trapezoid(11.0, 9.0, 1.0, 1.0)), 2),
    "to a joint, then on": (sequence(trapezoid(9.0, 11.0, 1.0, 1.0), trapezoid(11.0, 13.0, 1.0, 1.0)), 3),
    "past joints and back": (sequence(trapezoid(9.8, 11.5, 1.5, 2.0), trapezoid(11.5, 9.0, 1.5, 2.0)), 6),
    "past a joint as its drive switches": (trapezoid(9.5, 13.0, 1.0, 1.0), 5),
    "touching a joint": (Motion(np.array([0.0, 4.0]), np.array([[10.0, 1.0, -0.5]])), 0),
    "in motion outward": (Motion(np.array([0.0, 4.0]), np.array([[11.5, 0.5]])), 1),
    "in motion from a joint inward": (Motion(np.array([0.0, 4.0]), np.array([[12.5, -0.5]])), 1),
}
"""Ways of a trolley and how many joints it passes in them; in motion it passes some as a row is written."""


def begun(planar):
    """Model, motions, phases and a state in which all moves."""
    crane, motions = model(planar), jointed.motions(planar)
    cut = phases(tuple(motions[channel] for channel in crane.channels), END)
    state, n, rng = begin(crane, cut.inputs[0], Start(along=0.1)), crane.coordinates, np.random.default_rng(3)
    state[n + crane.axes : 2 * n + crane.axes] = 0.05 * crane.system.scale[:n] * rng.normal(size=n)
    return crane, motions, cut, state


def drawn(crane, state):
    """Coordinates with the load's angles, and their rates."""
    n, axes = crane.coordinates, crane.axes
    rope, swing = state[n : n + axes], state[2 * n + axes : 2 * (n + axes)]
    theta, theta_rate = np.arctan2(rope[0], -rope[-1]), (rope[0] * swing[-1] - rope[-1] * swing[0])
    angles, rates = [theta], [theta_rate / (rope[0] ** 2 + rope[-1] ** 2)]
    if axes == 3:
        angles.append(np.arcsin(rope[1]))
        rates.append(swing[1] / np.sqrt(1.0 - rope[1] ** 2))
    return np.append(state[:n], angles), np.append(state[n + axes : 2 * n + axes], rates)


def by_momenta(planar, blend=0.0, rtol=1e-10):
    crane, motions, cut, state = begun(planar)
    moments = [cut.times[1:-1]]
    for sign in {-1.0, 1.0} if blend else {0.0}:
        moved = Motion(motions["trolley"].switch_times, motions["trolley"].coefficients - sign * blend * np.eye(3)[0])
        shifted = phases(tuple({**motions, "trolley": moved}[channel] for channel in crane.channels), END)
        moments.append(crane.system.crossings.cut(shifted).times[1:-1])
    oracle = Momenta(crane, jointed.CRANE, motions, blend)
    return oracle.run(*drawn(crane, state), (0.0, END), np.concatenate(moments), rtol)


@cache
def passed(planar, jumps=True):
    """Coordinates and rates at the end of a run, and their sizes."""
    crane, _, cut, state = begun(planar)
    system = crane.system
    if not jumps:
        still = dataclasses.replace(system.crossings)
        object.__setattr__(still, "leap", lambda state, *_: state)
        system = dataclasses.replace(system, crossings=still)
    run = integrate(system, cut, state, np.array([END]), rtol=1e-12, atol=1e-15)
    return *drawn(crane, run.end_state), np.append(crane.system.scale[: crane.coordinates], np.ones(crane.axes - 1))


def apart(found, expected):
    """Of coordinates and of rates, over their sizes."""
    size = found[2]
    return [float(np.max(abs(a - b) / size)) for a, b in zip(found[:2], expected[:2], strict=True)]


@PLANES
def test_a_trolley_passes_joints_as_if_momenta_were_the_states(planar):
    expected = by_momenta(planar)
    place, rate = apart(passed(planar), expected)
    assert place < 1e-10
    assert rate < 1e-9
    # Without the jump of the rates a run would be off by far more.
    place, rate = apart(passed(planar, jumps=False), expected)
    assert place > 1e-6
    assert rate > 1e-5


def test_a_kink_that_is_blended_tends_to_the_jump_with_its_squared_width():
    gaps = [apart(passed(True), by_momenta(True, blend, 1e-9))[0] for blend in (0.1, 0.05)]
    assert gaps[1] < 2e-6
    assert 3.2 < gaps[0] / gaps[1] < 4.8


@PLANES
@pytest.mark.parametrize("way", WAYS)
def test_energy_is_the_work_of_the_drives_past_joints(way, planar):
    trolley, joints = WAYS[way]
    crane, motions = model(planar), jointed.motions(planar, trolley)
    duration = 2.0 if way.startswith(("in motion", "touching")) else 4.0
    cut = crane.system.crossings.cut(phases(tuple(motions[channel] for channel in crane.channels), duration))
    assert np.count_nonzero(np.diff(cut.inputs[:, -1, 0])) == joints
    assert balance(crane, motions, duration, start=Start("zero", along=0.2), rtol=1e-11, atol=1e-13) < 1e-11


def balance(crane, motions, duration, **options):
    """Largest gap in the balance of energy, over what the energy changes by."""
    run = record(crane, motions, duration, **{"start": Start("zero"), **options})
    assert run.attrs["outcome"] == "finished"
    energy, work = (np.asarray(run[name].values) for name in ("total_energy", "input_work"))
    return float(np.max(abs(energy - energy[0] - work + work[0])) / np.ptp(energy))


@pytest.mark.parametrize("method", ["dopri5", "scipy-dop853", "scipy-rk45", "scipy-radau", "scipy-lsoda"])
def test_every_method_passes_joints(method):
    tolerance = 1e-6 if method == "scipy-radau" else 1e-9
    options = {"method": method, "rtol": tolerance, "atol": 1e-2 * tolerance}
    assert balance(model(True), jointed.motions(True), 3.0, **options) < 30.0 * tolerance


@PLANES
def test_runs_side_by_side_pass_joints_as_they_do_alone(planar):
    crane, tight = model(planar), {"rtol": 1e-11, "atol": 1e-13}
    names = [way for way in WAYS if not way.startswith(("in motion", "touching"))]
    driven = [jointed.motions(planar, WAYS[name][0]) for name in names]
    cuts = [phases(tuple(motions[channel] for channel in crane.channels), 4.0) for motions in driven]
    rows = np.linspace(0.0, 4.0, 41)
    beside = integrate_many([LaneRun(crane, cut) for cut in cuts], rows, threads=1, **tight)
    for cut, state in zip(cuts, beside.end_states, strict=True):
        start = crane.start(cut.inputs[0])
        alone = integrate(crane.system, cut, start, rows, **tight).end_state
        assert np.max(abs(state - alone)[:-1] / crane.system.scale[:-1]) < 1e-12


def test_a_row_at_a_joint_is_of_the_section_that_begins_there():
    trolley, _ = WAYS["in motion outward"]
    rows = record(model(True), jointed.motions(True, trolley), 2.0, output_step=1.0, rtol=1e-11, atol=1e-13)
    dense = record(model(True), jointed.motions(True, trolley), 2.0, output_step=1.0 / 1024.0, rtol=1e-11, atol=1e-13)
    force = np.asarray(dense["trolley_force"].values)
    # The slope of the trolley's way steps where it is at 12 m.
    before, at, after = force[1023:1026]
    assert abs(after - at) < 0.2 * abs(at - before)
    assert np.asarray(rows["trolley_force"].values)[1] == pytest.approx(at, rel=1e-9)


def test_a_jib_of_many_segments_keeps_its_energy():
    length, count = 60.0, 80
    taper = np.linspace(1.0, 0.3, count)
    rows = [(length / count, 260.0 * f, 3e9 * f**2, 1.5e8 * f, 130.0 * f) for f in taper]
    jib = sectioned.chain(rows, {})
    crane = dataclasses.replace(sectioned.CRANE, jib=jib, jib_lateral=None)
    many = space.model(
        tower=1, torsion=0, lateral=0, vertical=2, counter=(0, 1), planes=1, slewing="fixed", axes=2, crane=crane
    )
    motions = {"trolley": trapezoid(9.8, 16.0, 3.0, 3.0), "rope": rest(12.0)}
    assert balance(many, motions, 4.0, rtol=1e-11, atol=1e-13) < 1e-11
