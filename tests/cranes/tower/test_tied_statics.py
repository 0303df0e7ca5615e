"""A hammerhead's ties at rest and its natural vibration, beside frame elements with sixteen sagged ones in each tie.

What the elements gave is printed in the tests; they share nothing with this code.
"""

import dataclasses
from functools import cache

import numpy as np
import pytest
from samples import hammerhead as sample
from scipy.linalg import eigh
from scipy.optimize import brentq

from modal import Chain, EndBody, Segment
from towercrane.cranes.tower.equations.tied.ties import pull_ties, span_of
from towercrane.cranes.tower.modes import jib_shapes
from towercrane.cranes.tower.modes.tied.shapes import Pull, hinged_shapes, static_shape
from towercrane.cranes.tower.tied_model import curvature
from towercrane.simulation.differences import jacobian

PLANE = {"lateral": 0, "planes": 1, "axes": 2, "slewing": "fixed"}


@cache
def plane(vertical=3, back=1):
    return sample.model(vertical=vertical, back=back, **PLANE)


@cache
def space():
    return sample.model(lateral=3, vertical=1, aside=2, back=0)


class Small:
    """Small motions on a head that stands still, with what may be left out of them."""

    def __init__(self, model):
        self.model, self.tied = model, model.constants.tied
        self.q = model.undeformed(np.zeros((len(model.channels), 3)))[-model.crane.tied.count :]
        self.own = model.crane.tied

    def stiffness(self, sag="own", geometry="all"):
        tied, q, n = self.tied, self.q, self.own.count
        spans = [span_of(tied, k, q) for k in range(tied.count)]
        slopes = np.array([span.slopes for span in spans])
        compliance = np.linalg.inv(tied.stiffness)
        weights = 9.81 * self.own.masses * abs(tied.spans[:, 0]) / tied.lengths**2
        if sag == "ernst":
            compliance = compliance + np.diag(weights**2 * tied.lengths**3 / 12.0 / tied.pretension**3)
        elif sag == "own":
            slopes[np.arange(tied.count), tied.sags + np.arange(tied.count)] = tied.slack
        found = np.diag(self.model.angular_frequencies[-n:] ** 2) + slopes.T @ np.linalg.solve(compliance, slopes)
        for k, tension in enumerate(tied.pretension):
            u, _, w = spans[k].direction
            column = self.own.part(4)
            if geometry == "all":
                found += tension * curvature(tied, k, q)
            elif geometry == "compression":
                found += tension * u * tied.along[k]
                found[column, column] += tension * w * tied.across[k][column, column]
            for bow in range(tied.sags + k, n, tied.count):
                found[bow, bow] += tension * np.pi**2 / (2.0 * tied.lengths[k])
        return found

    def mass(self, half):
        sums = self.model.crane.tied_sums if not half else None
        if sums is not None:
            return np.einsum("ijkk->ij", sums.products)
        found, own = np.zeros((self.own.count, self.own.count)), self.own
        products, column = self.model.crane.slewing.products, own.part(4)
        found[: len(products), : len(products)] = products
        found[column, column] = own.column.mass_matrix()
        for mass, *ends in zip(own.masses, *own.ends(), strict=True):
            found += sum(0.5 * mass * moved @ moved.T for moved in ends)
        return found

    def frequencies(self, rows, *, half=False, **options):
        kept = np.ix_(rows, rows)
        squared = eigh(self.stiffness(**options)[kept], self.mass(half)[kept], eigvals_only=True)
        return np.sqrt(squared) / (2.0 * np.pi)

    def upright(self, ties=True):
        lateral = self.own.counts[0] + self.own.counts[1]
        return np.arange(lateral, self.own.part(5).stop if ties else self.tied.sags)

    def sideways(self, ties=True):
        lateral = np.arange(self.own.counts[0] + self.own.counts[1])
        return np.concatenate([lateral, np.arange(self.own.part(6).start, self.own.count)]) if ties else lateral


def test_members_are_level_at_their_ties_under_the_crane_alone():
    small = Small(plane())
    level = small.own.ends()[1][:, :, 2]
    assert np.max(abs(level[range(3), :] @ small.q)) < 1e-12
    taut = pull_ties(small.tied, small.q)
    weight = -9.81 * small.model.crane.tied_sums.momentum[:, 2]
    left = weight + taut.forces - small.model.angular_frequencies[-len(small.q) :] ** 2 * small.q
    assert np.max(abs(left)) < 1e-9 * np.max(abs(weight))
    assert taut.tensions == pytest.approx(small.tied.pretension, rel=1e-12)


def test_tensions_under_the_crane_alone():
    """107.459, 168.822, 248.826 kN of straight members; 266 and 167 kN compress the jib."""
    small = Small(plane(vertical=8))
    tied, rows = small.tied, small.upright(ties=False)
    slopes = np.array([span_of(tied, k, np.zeros(small.own.count)).slopes for k in range(3)])[:, rows]
    level, weight = (
        small.own.ends()[1][range(3), :, 2][:, rows],
        -9.81 * small.model.crane.tied_sums.momentum[rows, 2],
    )
    stiffness = np.diag(small.model.angular_frequencies[-small.own.count :] ** 2)[np.ix_(rows, rows)]
    matrix = np.block([[stiffness, slopes.T], [level, np.zeros((3, 3))]])
    straight = np.linalg.solve(matrix, np.concatenate([weight, np.zeros(3)]))[-3:]
    assert straight == pytest.approx([107_459.0, 168_822.0, 248_826.0], rel=1e-4)
    assert straight[2] == pytest.approx(248_826.0, rel=3e-6)
    assert tied.pretension == pytest.approx([107_459.0, 168_822.0, 248_826.0], rel=2.5e-3)
    pushed = tied.pretension * abs(tied.spans[:, 0]) / tied.lengths
    assert [pushed[:2].sum(), pushed[1]] == pytest.approx([266e3, 167e3], rel=5e-3)


def test_vertical_frequencies_are_those_of_frame_elements():
    """.8918 1.0906 1.7982 2.4705 Hz, the second and third of the ties themselves; by the same theory .8921 1.0914
    1.7955 2.4680."""
    small = Small(plane())
    found = small.frequencies(small.upright())[:4]
    assert found == pytest.approx([0.8918, 1.0906, 1.7982, 2.4705], rel=3e-3)
    assert found == pytest.approx([0.8921, 1.0914, 1.7955, 2.4680], rel=1.5e-3)
    assert found[0] == pytest.approx(0.8921, rel=3e-4)


def test_lateral_frequencies_are_those_of_frame_elements():
    small = Small(space())
    assert small.frequencies(small.sideways())[:2] == pytest.approx([0.3968, 0.8426], rel=8e-4)
    # Ties that do not bow to their sides themselves.
    assert small.frequencies(small.sideways(ties=False))[0] > 0.3985


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"sag": "ernst"}, (0.8819, 2.4468)), ({"sag": "full"}, (0.951, 2.756)),
        ({"sag": "ernst", "geometry": "none"}, (0.883, 2.456)),
        ({"sag": "ernst", "geometry": "compression"}, (0.868, 2.442)),
    ],
)  # fmt: skip
def test_what_is_left_out_moves_vertical_frequencies_as_in_frame_elements(options, expected):
    """All with half of each tie's mass at its ends."""
    small = Small(plane())
    found = small.frequencies(small.upright(ties=False), half=True, **options)[:2]
    assert found == pytest.approx(expected, rel=2.5e-3)
    assert found[0] == pytest.approx(expected[0], rel=6e-4)
    assert abs(found[0] / 0.8921 - 1.0) > 9e-3


@pytest.mark.parametrize(("geometry", "expected"), [("all", 0.3911), ("none", 0.3968), ("compression", 0.3603)])
def test_ties_pull_back_the_jib_that_they_compress(geometry, expected):
    """With half masses; compression alone would take 8 per cent, in truth 1.4 are missing."""
    small = Small(space())
    found = small.frequencies(small.sideways(ties=False), half=True, geometry=geometry)[0]
    assert found == pytest.approx(expected, rel=6e-4)


@pytest.mark.parametrize(("count", "error"), [(1, 1e-2), (12, 3e-3)])
def test_modes_converge_slowly_without_the_shapes_under_the_ties(monkeypatch, count, error):
    small = Small(plane())
    expected, tensions = small.frequencies(small.upright())[0], small.tied.pretension
    monkeypatch.setattr(jib_shapes, "hinged_shapes", lambda chain, many, _pulls: hinged_shapes(chain, many, ()))
    stated = [
        tuple(
            dataclasses.replace(tie, pretension=float(tension)) for tie, tension in zip(ties, tensions, strict=True)
        )
        for ties, tensions in ((sample.JIB_TIES, tensions[:2]), (sample.BACK_TIE, tensions[2:]))
    ]
    crane = sample.crane(jib=stated[0], counter_jib=stated[1])
    small = Small(sample.model(vertical=count, back=12, crane=crane, **PLANE))
    assert small.frequencies(small.upright())[0] / expected - 1.0 == pytest.approx(error, rel=0.5)


@pytest.mark.parametrize(
    ("mass", "place", "tensions", "sinks", "frequency"),
    [(3000.0, 50.0, (134e3, 319e3), -0.341, 0.7048), (6000.0, 30.0, (256e3, 240e3), -0.252, 0.7848)],
)
def test_a_load_moves_tensions_tip_and_frequency_as_in_frame_elements(mass, place, tensions, sinks, frequency):
    crane = sample.bare(trolley_mass=0.0)
    model = sample.model(vertical=3, load=mass, crane=crane, **PLANE)
    inputs = np.array([[place, 0.0, 0.0], [20.0, 0.0, 0.0]])
    q, alone = model.equilibrium(inputs), model.undeformed(inputs)
    assert pull_ties(model.constants.tied, q).tensions[:2] == pytest.approx(tensions, rel=5e-3)
    tip = model.crane.vertical([60.0])[:, 0] @ (q - alone)[model.parts["jib_vertical"]]
    assert tip == pytest.approx(sinks, rel=1e-2)
    slope, _ = jacobian(lambda p: model.static_forces(p, inputs), q, model.system.scale[: len(q)])
    resting = model.at_rest(q, inputs)
    row = np.array(resting.jacobian)[1]
    mass_matrix = resting.mass_matrix() + mass * np.outer(row, row)
    squared = eigh(-0.5 * (slope + slope.T), mass_matrix, eigvals_only=True)
    assert np.sqrt(squared[0]) / (2.0 * np.pi) == pytest.approx(frequency, rel=2e-3)


def catenary(tension, weight, length, stiffness):
    """Chord of a level elastic catenary of this unstretched length with this horizontal tension [m]."""
    return 2.0 * tension / weight * np.arcsinh(0.5 * weight * length / tension) + tension * length / stiffness


@pytest.mark.parametrize(("stretch", "error"), [(-0.03, 5e-3), (-0.01, 3e-3), (0.02, 3e-3), (0.06, 1.5e-3)])
def test_a_tie_pulls_as_an_elastic_catenary(stretch, error):
    """One bow of a sine is 98.6 per cent of the sag's give: tensions are right to a few thousandths."""
    small = Small(plane())
    tied, k = small.tied, 1
    tie = small.own.bars.jib[k]
    span, weight = tied.lengths[k], 9.81 * tie.mass_per_length * abs(tied.spans[k, 0]) / tied.lengths[k]
    start = tied.pretension[k]
    unstretched = brentq(lambda s: catenary(start, weight, s, tie.axial_stiffness) - span, 0.9 * span, 1.1 * span)
    expected = brentq(lambda t: catenary(t, weight, unstretched, tie.axial_stiffness) - span - stretch, 5e3, 3e6)

    def tension(sag):
        give = stretch + sag * (tied.slack[k] + np.pi**2 / (4.0 * span) * sag)
        return start + give * tie.axial_stiffness / span

    curve = np.pi**2 / (2.0 * span)
    sag = brentq(lambda a: tied.slack[k] * start - (tied.slack[k] + curve * a) * tension(a), -0.3, 1.0)
    assert tension(sag) == pytest.approx(expected, rel=error)


def test_a_static_shape_bends_as_its_pull_asks():
    """Its strain works on any shape what the pull does, less the inertia of the turn; with bodies and tapers."""
    chain = Chain(
        (Segment(20.0, 130.0, 6e8, 6e7, rotary_inertia=20.0),
         Segment(15.0, 100.0, 4e8, 5e7, 10.0, 0.6, 1.0, 2.0, 0.0, inclined_chords=True)),
        bodies={1: EndBody(900.0, 500.0, 0.7), 2: EndBody(400.0, 300.0, -0.5)},
    )  # fmt: skip
    chain, _ = chain.with_node(12.0)
    pull = Pull(12.0, 0.4, 1.3)
    others = hinged_shapes(chain, 3, [])
    bent = static_shape(chain, others.shapes.ends, pull, hinged=True)
    both = np.zeros((5, *others.shapes.coefficients.shape[1:]))
    both[:4], both[4, :, : bent.shape[1]] = others.shapes.coefficients, bent
    shapes = dataclasses.replace(others, shapes=dataclasses.replace(others.shapes, coefficients=both))
    turn = (pull.force * pull.place + pull.couple) / sum(chain.inertia[2:])
    asked = pull.force * others(pull.place) + pull.couple * others.rotation(pull.place)
    asked = asked - turn * (others.mass_moments()[1] + others.rotary_moments())
    worked = shapes.stiffness_matrix()[4, :4]
    assert worked == pytest.approx(asked, abs=1e-7 * np.max(abs(asked)))
    assert abs(asked[0]) < 1e-12 * np.max(abs(asked))
