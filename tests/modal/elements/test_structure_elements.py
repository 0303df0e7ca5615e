"""Finite elements of chains: published values, order of convergence, statics and buckling, the exact structure."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import numpy as np
import pytest
from numpy.testing import assert_allclose

from modal import (
    Chain,
    EndBody,
    Foundation,
    Pendulum,
    Segment,
    Structure,
    StructureElements,
    Unstable,
    chain_structure,
    finite_element_structure_frequencies,
)

UNIT = Segment(1.0, 1.0, 1.0)
SHEAR = 1.2452741e8


def tower(shear=inf, theory="haringx"):
    """Everything a chain can have."""
    return Chain(
        (
            Segment(10.0, 350.0, 2.9e9, shear, 30.0, 0.8, 1.0, 3.0, 1.0),
            Segment(13.8, 250.0, 2.2e9, shear, 20.0),
        ),
        {1: EndBody(500.0, 100.0, 0.3), 2: EndBody(23972.67, 9.480729e6, 1.2)},
        Foundation(5e9, 1e9),
        axial_load=2e5,
        gravity=9.81,
        pendulum=Pendulum(800.0, 18.0),
        shear_theory=theory,
    )


def frequencies(chain, count, elements):
    return finite_element_structure_frequencies(chain_structure(chain), count, elements=elements)


# --- published values ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("mass_power", "bending_power", "published"),
    [(1.0, 3.0, [5.3150994237, 15.207167955]), (2.0, 4.0, [8.7192588551, 21.145662388])],
    ids=["wedge", "cone"],
)
def test_cantilever_that_runs_to_an_edge_or_a_point(mass_power, bending_power, published):
    """Mabie and Rogers 1972 by Bessel functions; the last billionth of the breadth is cut off."""
    segment = Segment(1.0, 1.0, 1.0, end_ratio=1e-9, mass_power=mass_power, bending_power=bending_power)
    errors = np.array([frequencies(Chain((segment,)), 2, n) / published - 1.0 for n in (8, 16, 32)])
    # The cut lowers every frequency by twice the breadth cut off.
    errors += 2e-9
    order = np.log2(errors[:-1] / errors[1:])
    assert ((order > 3.9) & (order < 4.1)).all(), order
    assert (errors[-1] > [2e-9, 3e-7]).all(), errors[-1]
    assert (errors[-1] < [1.2e-8, 9e-7]).all(), errors[-1]


def test_column_buckles_under_its_own_weight():
    """Greenhill 1881: q L^3 / EI = 7.83734743894."""
    structure = chain_structure(Chain((UNIT,), gravity=1.0))
    errors = [StructureElements(structure, n).buckling_factor() / 7.83734743894 - 1.0 for n in (16, 32)]
    assert_allclose(errors, [8.4e-7, 5.26e-8], rtol=0.02)


@pytest.mark.parametrize(("part", "root"), [(0.25, 1.753139808), (0.5, 1.592030218), (0.9, 1.073906923)])
def test_load_on_the_tip_lowers_the_first_root(part, root):
    chain = Chain((UNIT,), axial_load=part * np.pi**2 / 4.0)
    error = np.sqrt(frequencies(chain, 1, 32)) / root - 1.0
    # The nearer to buckling, the more an error of the critical load, 1.6e-8 here, counts.
    assert -1e-9 < error[0] < 2e-8


def test_timoshenko_cantilever():
    chain = Chain((replace(UNIT, shear_stiffness=25.0, rotary_inertia=0.01),))
    assert_allclose(frequencies(chain, 2, 16), [3.173773108, 13.6606528], rtol=2e-9)


@pytest.mark.parametrize(("theory", "factor"), [("engesser", 1.0), ("haringx", None)])
def test_buckling_of_a_column_that_shears(theory, factor):
    """Engesser: P = P_E / (1 + P_E / S); Haringx: S (sqrt(1 + 4 P_E / S) - 1) / 2."""
    S, euler = 10.0, np.pi**2 / 4.0
    exact = euler / (1.0 + euler / S) if factor else 0.5 * S * (np.sqrt(1.0 + 4.0 * euler / S) - 1.0)
    chain = Chain((replace(UNIT, shear_stiffness=S),), axial_load=1.0, shear_theory=theory)
    assert_allclose(StructureElements(chain_structure(chain), 16).buckling_factor(), exact, rtol=2e-11)


# --- the exact structure -------------------------------------------------------------------------------


@pytest.mark.parametrize("theory", ["haringx", "engesser"])
@pytest.mark.parametrize(("shear", "order", "bound"), [(inf, (3.7, 4.1), 2e-6), (SHEAR, (5.6, 6.1), 2e-10)])
def test_tower_with_everything_against_the_exact_structure(theory, shear, order, bound):
    """Both in the third to fifth mode, where rounding does not reach."""
    structure = chain_structure(tower(shear, theory))
    exact = structure.angular_frequencies(5)
    errors = [finite_element_structure_frequencies(structure, 5, elements=n) / exact - 1.0 for n in (16, 32)]
    measured = np.log2(errors[0] / errors[1])[2:]
    assert ((measured > order[0]) & (measured < order[1])).all(), measured
    assert (errors[1] > -1e-12).all()
    assert (errors[1] < bound).all(), errors[1]
    assert errors[1][-1] > 0.3 * bound


@pytest.mark.parametrize(("shear", "low", "high"), [(inf, 3.9, 4.1), (25.0, 5.8, 6.1)])
def test_order_of_a_uniform_beam(shear, low, high):
    chain = Chain((replace(UNIT, shear_stiffness=shear, rotary_inertia=0.01),))
    exact = chain_structure(chain).angular_frequencies(4)
    errors = [frequencies(chain, 4, n)[1:] / exact[1:] - 1.0 for n in ((16, 32) if shear == inf else (6, 12))]
    order = np.log2(errors[0] / errors[1])
    assert ((order > low) & (order < high)).all(), order


def test_nothing_locks_however_stiff_in_shear():
    """The error is that of one more power of rigidity, no more than the beam without shear strain has."""
    exact = chain_structure(Chain((UNIT,))).angular_frequencies(2)
    for shear in (1e6, 1e9):
        found = frequencies(Chain((replace(UNIT, shear_stiffness=shear),)), 2, 8)
        bending = 2.0 / shear * exact
        assert_allclose(found, exact, rtol=20.0 * bending.max() + 1e-7)


@pytest.mark.parametrize("shear", [inf, SHEAR])
def test_split_is_as_unsplit(shear):
    whole = Segment(24.0, 350.0, 2.9e9, shear, 30.0, 0.6, 1.0, 3.0, 1.0)
    near, far = whole.split(9.0)
    split = Chain((near, far), gravity=9.81)
    # A mesh of the same nodes.
    assert_allclose(frequencies(split, 4, 16), frequencies(Chain((whole,), gravity=9.81), 4, 16), rtol=1e-10)


@pytest.mark.parametrize("gap", [1e-6, 0.05])
@pytest.mark.parametrize("shear", [inf, SHEAR])
def test_short_segment_costs_no_digits(shear, gap):
    whole = Chain((Segment(24.0, 350.0, 2.9e9, shear),), {1: EndBody(1e4, 1e6)})
    cut, _ = whole.with_node(9.0)
    cut, _ = cut.with_node(9.0 + gap)
    assert len(cut.segments) == 3
    # Elements of the two meshes differ: they agree as far as these do with the exact roots.
    exact = chain_structure(whole).angular_frequencies(3)
    assert_allclose(frequencies(cut, 3, 40), exact, rtol=3e-7)


def test_modes_are_those_of_the_structure():
    structure = chain_structure(replace(tower(SHEAR), axial_load=0.0, gravity=0.0))
    found, modes = StructureElements(structure, 32).modes(3)
    assert_allclose(found, structure.angular_frequencies(3), rtol=1e-11)
    # Static displacements under the load that would make a mode's motion are no mode, but their sum over all is.
    force = np.zeros(len(structure.unknowns))
    force[4] = 1.0
    static = StructureElements(structure, 32).displacements(force)
    _, many = StructureElements(structure, 32).modes(30)
    omega = StructureElements(structure, 32).angular_frequencies(30)
    assert_allclose(many @ (many[4] / omega**2), static, rtol=2e-4, atol=1e-6 * abs(static).max())
    assert (modes[np.abs(modes).argmax(axis=0), range(3)] > 0.0).all()


# --- statics -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("elements", [1, 7])
@pytest.mark.parametrize("shear", [inf, 2.0])
def test_cantilever_under_a_force_and_a_moment(shear, elements):
    chain = Chain((replace(UNIT, shear_stiffness=shear),))
    model = StructureElements(chain_structure(chain), elements)
    assert_allclose(model.displacements([1.0, 0.0]), [1.0 / 3.0 + 1.0 / shear, 0.5], rtol=1e-12)
    assert_allclose(model.displacements([0.0, 1.0]), [0.5, 1.0], rtol=1e-12)


def test_column_with_a_load_deflects_more():
    """tan(u) / u, u = sqrt(P / EI) L, for a moment's rotation at the tip."""
    u = np.sqrt(0.5 * np.pi**2 / 4.0)
    model = StructureElements(chain_structure(Chain((UNIT,), axial_load=u**2)), 16)
    assert_allclose(model.displacements([0.0, 1.0])[1], np.tan(u) / u, rtol=1e-7)
    assert_allclose(model.displacements([1.0, 0.0])[0], (np.tan(u) - u) / u**3, rtol=1e-7)


# --- refusals ------------------------------------------------------------------------------------------


def test_column_loaded_beyond_buckling_is_unstable_and_says_by_how_much():
    chain = Chain((UNIT,), axial_load=2.0 * np.pi**2 / 4.0)
    for question in (lambda m: m.angular_frequencies(1), lambda m: m.displacements([1.0, 0.0])):
        with pytest.raises(Unstable, match=r"only 0\.5 times"):
            question(StructureElements(chain_structure(chain)))


def test_tension_and_no_load_never_buckle():
    assert StructureElements(chain_structure(Chain((UNIT,), axial_load=-1.0))).buckling_factor() == inf
    assert StructureElements(chain_structure(Chain((UNIT,)))).buckling_factor() == inf


def test_what_nothing_holds_is_refused():
    free = Structure(())
    free.add_chain(Chain((UNIT,)), (free.add_unknown("m"), free.add_unknown("rad")))
    with pytest.raises(ValueError, match="without support"):
        StructureElements(free).angular_frequencies(1)


def test_numbers_that_make_no_sense():
    structure = chain_structure(Chain((UNIT,)))
    with pytest.raises(ValueError, match=r"elements: wanted at most 256, got 257"):
        StructureElements(structure, 257)
    with pytest.raises(ValueError, match="count: wanted less than the 8 unknowns"):
        StructureElements(structure, 4).angular_frequencies(8)
    with pytest.raises(ValueError, match="count: wanted zero or more"):
        StructureElements(structure, 4).angular_frequencies(-1)
    with pytest.raises(ValueError, match=r"forces: wanted one for each of 2 unknowns, got shape \(3,\)"):
        StructureElements(structure, 4).displacements([1.0, 0.0, 0.0])
    # A section without rotary inertia moves by its deflection alone.
    shear = chain_structure(Chain((replace(UNIT, shear_stiffness=1.0),)))
    with pytest.raises(ValueError, match="less than the 8 unknowns"):
        StructureElements(shear, 2).angular_frequencies(8)
