"""Natural frequencies of chains against 60-digit determinants, collocation and published figures; critical loads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from oracles.collocation import collocated_chain
from oracles.determinants import has_root_within

from modal.beams.beam import EndBody
from modal.beams.chain import Chain, Foundation, Pendulum
from modal.beams.roots import characteristic_roots
from modal.beams.segment import Segment
from modal.structures.members import HELD, Member, Unstable
from modal.structures.structure import Structure, chain_frequencies, chain_structure

INF = float("inf")
BEAM = Segment(1.0, 1.0, 1.0)
STEPPED = (Segment(0.4, 1.0, 1.0), Segment(0.6, 0.5, 0.3))
TIMOSHENKO = Segment(1.0, 1.0, 1.0, 10.0, 0.01)
BODIES = {0: EndBody(0.5, 0.1, 0.05), 1: EndBody(0.3, 0.02, 0.1), 2: EndBody(2.0, 0.5, -0.2)}
COLUMN = np.pi**2 / 4

UNIFORM = {
    "clamped": Chain((BEAM,)),
    "compressed": Chain((BEAM,), axial_load=2.0),
    "near buckling": Chain((BEAM,), axial_load=0.9 * COLUMN),
    "taut": Chain((BEAM,), axial_load=-30.0),
    "string": Chain((Segment(1.0, 1.0, 0.01),), axial_load=-10.0),
    "shear and rotary inertia": Chain((Segment(1.0, 1.0, 1.0, 25.0, 0.01),)),
    "above the shear cut-off": Chain((Segment(1.0, 1.0, 1.0, 8.0, 0.2),)),
    "haringx": Chain((TIMOSHENKO,), axial_load=1.2),
    "engesser": Chain((TIMOSHENKO,), axial_load=1.2, shear_theory="engesser"),
    "taut haringx": Chain((TIMOSHENKO,), axial_load=-4.0),
    "taut engesser": Chain((TIMOSHENKO,), axial_load=-4.0, shear_theory="engesser"),
    "soft foundation": Chain((BEAM,), foundation=Foundation(1e-2, 1e-1)),
    "stiff foundation": Chain((BEAM,), foundation=Foundation(1e4, 1e5)),
    "bodies beside all nodes": Chain(STEPPED, BODIES, Foundation(20.0, 100.0)),
    "pendulum": Chain(STEPPED, {2: EndBody(0.3, 0.02)}, pendulum=Pendulum(0.3, 0.7)),
    "soft and stiff in turn": Chain(
        tuple(Segment(0.1, 1.0 - 0.05 * i, 90.0 if i % 2 else 1.0, 30.0) for i in range(10)), {10: BODIES[1]}
    ),
    "stepped, all effects": Chain(
        (TIMOSHENKO, Segment(0.7, 0.4, 0.5, 6.0, 0.02)), BODIES, Foundation(5.0), 0.1, shear_theory="engesser"
    ),
}
TAPER = (
    Segment(0.5, 1.0, 1.0, 30.0, 0.01, end_ratio=0.5, mass_power=1, bending_power=3, shear_power=1.0),
    Segment(0.5, 1.0, 1.0, 20.0, 0.0, end_ratio=1.5, mass_power=2, bending_power=4, shear_power=0.5),
)
VARIABLE = {
    "own weight": Chain((BEAM,), gravity=6.0),
    "weight of bodies off their nodes": Chain(STEPPED, {1: BODIES[1], 2: EndBody(0.3, 0.5, 0.2)}, gravity=0.5),
    "weight of a pendulum": replace(UNIFORM["pendulum"], gravity=0.5),
    "taper": Chain((Segment(1.0, 1.0, 1.0, end_ratio=0.2, mass_power=1, bending_power=3),)),
    "tapers, haringx": Chain(TAPER, {2: EndBody(0.5, 0.1, 0.1)}, axial_load=-0.1, gravity=0.6),
    "tapers, engesser": Chain(
        TAPER, {2: EndBody(0.5, 0.1, 0.1)}, axial_load=0.1, gravity=0.6, shear_theory="engesser"
    ),
    "inclined chords": Chain(
        (
            Segment(0.6, 1.0, 1.0, 9.0, 0.02, 0.4, 0.5, 2.0, -0.7, inclined_chords=True),
            Segment(0.4, 0.8, 0.2, 5.0, 0.0, 1.3, 0.0, 2.0, 1.5, inclined_chords=True),
        ),
        {2: EndBody(0.5, 0.1, 0.1)},
        axial_load=0.05,
        gravity=0.1,
    ),
    "inclined chords, engesser": Chain(
        (Segment(1.0, 1.0, 1.0, 9.0, 0.02, 0.4, 0.5, 2.0, -0.7, inclined_chords=True),),
        {1: EndBody(0.5, 0.1, 0.1)},
        axial_load=0.05,
        gravity=0.1,
        shear_theory="engesser",
    ),
    "parallel diagonals on inclined chords": Chain(
        (
            Segment(0.6, 1.0, 1.0, 9.0, 0.02, 0.4, 0.5, 2.0, -0.7, inclined_chords=True, coupling=1.3),
            Segment(0.4, 0.8, 0.2, 5.0, 0.0, coupling=-2.0),
        ),
        {2: EndBody(0.5, 0.1, 0.1)},
        axial_load=0.05,
        gravity=0.1,
    ),
    "thin end under weight": Chain(
        (Segment(1.0, 1.0, 1.0, 2.0, end_ratio=0.3, mass_power=2, bending_power=3, shear_power=1),),
        gravity=1.5,
        shear_theory="engesser",
    ),
}


@pytest.mark.parametrize("name", [*UNIFORM, *VARIABLE])
def test_frequencies_are_those_of_collocation(name):
    chain = {**UNIFORM, **VARIABLE}[name]
    np.testing.assert_allclose(chain_frequencies(chain, 4), collocated_chain(chain, 4), rtol=1e-11)


@pytest.mark.parametrize("name", UNIFORM)
def test_frequencies_are_those_of_60_digit_arithmetic(name):
    structure = chain_structure(UNIFORM[name])
    # Little stiffness left in the slowest mode is the small difference of large ones.
    lost = {"near buckling": 1e-12, "soft foundation": 1e-11}.get(name, 2e-13)
    for k, frequency in enumerate(structure.angular_frequencies(6)):
        assert has_root_within(UNIFORM[name], frequency, lost), (k, frequency)
        assert structure.count_below(frequency * (1.0 - 1e-11)) == k
        assert structure.count_below(frequency * (1.0 + 1e-11)) == k + 1


@pytest.mark.parametrize("mass", [1e-8, 1e-4, 1e4, 1e8])
@pytest.mark.parametrize("inertia", [1e-8, 1e8])
def test_neither_heavy_nor_light_bodies_cost_digits(mass, inertia):
    chain = Chain((TIMOSHENKO, *STEPPED), {1: EndBody(mass, inertia), 3: EndBody(1.0 / mass, inertia)})
    for frequency in chain_frequencies(chain, 8):
        assert has_root_within(chain, frequency, 1e-11), frequency


def test_tip_loads_and_shear_have_their_published_roots():
    for part, root in ((0.25, 1.753139808), (0.5, 1.592030218), (0.9, 1.073906923)):
        frequency = chain_frequencies(Chain((BEAM,), axial_load=part * COLUMN), 1)
        np.testing.assert_allclose(np.sqrt(frequency), root, atol=5e-10)
    beam = Segment(1.0, 1.0, 1.0, 1.0 / 0.04, 0.01)
    np.testing.assert_allclose(chain_frequencies(Chain((beam,)), 2), (3.173773108, 13.6606528), rtol=4e-9)


QTZ_TOWER, QTZ_BODY = Segment(23.8, 350.0, 206e9 * 0.014), EndBody(23972.67, 9.480729e6)
WEIGHT = 9.81 * QTZ_BODY.mass


def qtz_roots(**changes):
    segment = replace(QTZ_TOWER, shear_stiffness=changes.pop("shear", INF))
    frequencies = chain_frequencies(Chain((segment,), {1: QTZ_BODY}, **changes), 4)
    return np.sqrt(frequencies * np.sqrt(350.0 / (206e9 * 0.014))) * 23.8


def test_published_tower_with_shear_weight_and_a_soft_base():
    plain, sheared = qtz_roots(), qtz_roots(shear=1.2e8)
    np.testing.assert_allclose(plain, characteristic_roots(2.877872, 2.009291, 4), rtol=2e-7)
    np.testing.assert_allclose(sheared, [0.7661, 1.3709, 3.6142, 5.1478], atol=5e-5)
    np.testing.assert_allclose(100.0 * ((sheared / plain) ** 2 - 1.0), [-0.8, -17.8, -43.3, -57.5], atol=0.05)
    np.testing.assert_allclose(qtz_roots(axial_load=WEIGHT)[0], 0.7657, atol=5e-5)
    base = Foundation(20.0 * 206e9 * 0.014 / 23.8)
    np.testing.assert_allclose(qtz_roots(foundation=base)[0], 0.7538, atol=5e-5)


def test_haringx_and_engesser_differ_as_published():
    haringx, engesser = (
        qtz_roots(shear=1.2e8, axial_load=WEIGHT, shear_theory=theory) for theory in ("haringx", "engesser")
    )
    np.testing.assert_allclose((haringx / engesser - 1.0)[[0, 2]], (8.34e-6, 3.35e-4), rtol=2e-3)


def test_stepwise_weight_converges_to_the_exact_linear_one():
    def stepwise(count):
        structure, near, step = Structure(()), (HELD, HELD), 60.0 / count
        for i in range(count):
            far = structure.add_unknown("m"), structure.add_unknown("rad")
            above = WEIGHT + 9.81 * 350.0 * (60.0 - (i + 0.5) * step)
            structure.members.append(Member(replace(QTZ_TOWER, length=step), (*near, *far), compression=above))
            near = far
        structure.add_body(QTZ_BODY, *near)
        return structure.angular_frequencies(1)[0] / (2.0 * np.pi)

    tower = Chain((replace(QTZ_TOWER, length=60.0),), {1: QTZ_BODY}, gravity=9.81)
    exact = chain_frequencies(tower, 1)[0] / (2.0 * np.pi)
    coarse = [stepwise(count) for count in (1, 2, 4, 8, 16)]
    np.testing.assert_allclose(coarse, [0.15497, 0.15644, 0.15675, 0.15683, 0.15685], atol=6e-6)
    errors = exact - np.array([*coarse[3:], stepwise(32)])
    ratios = errors[:-1] / errors[1:]
    assert (ratios > 3.9).all()
    assert (ratios < 4.1).all()


@pytest.mark.parametrize("softness", [1e-6, 1e-11, 1e-30])
def test_a_column_far_too_soft_for_its_weight_is_named_without_cutting_it_to_pieces(softness):
    segment = replace(BEAM, bending_stiffness=softness * BEAM.bending_stiffness)
    column = chain_structure(Chain((segment,), gravity=1.0))
    stiff = chain_structure(Chain((BEAM,), gravity=1.0)).buckling_factor()
    np.testing.assert_allclose(column.buckling_factor(), softness * stiff, rtol=1e-12)
    with pytest.raises(Unstable, match=f"carries only {softness * stiff:.4g} times"):
        column.angular_frequencies(3)
    with pytest.raises(Unstable):
        column.displacements(np.array([1.0, 0.0]))


def test_columns_buckle_under_their_weight_and_with_shear():
    own = chain_structure(Chain((BEAM,), gravity=1.0)).buckling_factor()
    np.testing.assert_allclose(own, 7.83734743894, rtol=1e-12)
    for shear in (0.01, 1.0, 10.0, 1e4):
        loaded = Chain((replace(BEAM, shear_stiffness=shear),), axial_load=1.0)
        haringx = chain_structure(loaded).buckling_factor()
        engesser = chain_structure(replace(loaded, shear_theory="engesser")).buckling_factor()
        np.testing.assert_allclose(haringx, 0.5 * shear * (np.sqrt(1.0 + 4.0 * COLUMN / shear) - 1.0), rtol=1e-11)
        np.testing.assert_allclose(engesser, COLUMN / (1.0 + COLUMN / shear), rtol=1e-12)
    assert chain_structure(Chain((BEAM,), axial_load=-1.0)).buckling_factor() == INF
    # Haringx lets a shear-soft rod buckle in tension too, where the force exceeds S.
    taut = chain_structure(Chain((replace(BEAM, shear_stiffness=1.0),), axial_load=-1.0)).buckling_factor()
    np.testing.assert_allclose(taut, 0.5 * (1.0 + np.sqrt(1.0 + 4.0 * COLUMN)), rtol=1e-12)


def test_what_buckles_says_under_which_part_of_its_load():
    with pytest.raises(Unstable, match=r"carries only 0\.5 times"):
        chain_frequencies(Chain((BEAM,), axial_load=2.0 * COLUMN), 1)
    sheared = Chain((replace(BEAM, shear_stiffness=1e9),), axial_load=1.08 * COLUMN, shear_theory="engesser")
    with pytest.raises(Unstable, match=r"carries only 0\.9259 times"):
        chain_frequencies(sheared, 1)
    # Close below it the first frequency goes to zero as the root of what is left.
    near, nearer = (chain_frequencies(Chain((BEAM,), axial_load=part * COLUMN), 1)[0] for part in (0.999, 0.99999))
    np.testing.assert_allclose(near / nearer, 10.0, rtol=1e-3)
