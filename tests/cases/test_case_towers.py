"""The door for general towers: segments, lattices, bodies, foundations, and what a run rests on."""

import re
from math import inf

import pytest
from samples.tower_files import FLEXIBLE, LACED, MEMBERS, ONE_SEGMENT, SEGMENTS, TIED, UNIFORM

from modal import Beam, Chain, Collar, EndBody, Foundation, LacedColumn, Segment
from towercrane.cases.assumptions import rests_on
from towercrane.cases.case import load_case
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.effects import kept_tower
from towercrane.cranes.tower.file.members import beam_choice, lattice_of
from towercrane.cranes.tower.file.tower_tables import Block, Tower, TowerBody, TowerSegment
from towercrane.cranes.tower.file.tower_tables import Collar as CollarTable
from towercrane.cranes.tower.file.tower_tables import Foundation as FoundationTable

E = 210e9
COLUMN = LacedColumn(50e-4, 1.7, 1.4, 8e-4, E, "X", 6e-4)
MAST = Segment(18.0, 350.0, COLUMN.bending_stiffness.value, COLUMN.shear_stiffness.value, 350.0 * 0.85**2)


def same(one, other):
    """Chains equal but for the last digits that units cost."""
    numbers = [re.split(r"(-?\d[\d.e+-]*|inf)", repr(chain)) for chain in (one, other)]
    assert numbers[0][::2] == numbers[1][::2]
    assert [float(x) for x in numbers[0][1::2]] == pytest.approx([float(x) for x in numbers[1][1::2]], rel=1e-14)


# What is read


def test_a_segmented_tower_is_the_chain_built_by_hand(write_tower):
    foot = Segment(12.0, 500.0, 206e9 * 0.02, 150e6, 300.0, 0.6, 1.0, 3.0, 1.0)
    cut = MAST.split(8.0)
    # A body of 100 t at the foot, and the block of 40 t one metre below.
    block = EndBody(140e3, 300e3 + 100e3 * 40.0 / 140.0, -40.0 / 140.0)
    bodies = {0: block, 3: EndBody(2000.0, 3000.0, -0.4), 4: EndBody(5000.0, 0.0, 1.0)}
    ground, collars = Foundation(2e9, 300e6, -200e6), {1: Collar(10e6), 3: Collar(20e6, 30e6)}
    same(
        kept_tower(load_case(write_tower(TIED)).checked),
        Chain((*foot.split(8.0), *cut), bodies, ground, shear_theory="engesser", collars=collars),
    )


def test_every_key_of_the_tables_is_in_the_file_of_these_tests():
    for table in (TowerSegment, TowerBody, FoundationTable, Block, CollarTable):
        assert all(f"{name} =" in TIED + MEMBERS or f".{name}]" in TIED for name in table.model_fields)
    elsewhere = {"height", "beam", "published_roots", *TowerSegment.model_fields}
    assert set(Tower.model_fields) - elsewhere == {
        "segments", "bodies", "collars", "shear_theory", "torsional_stiffness", "torsional_inertia_per_length",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("key", "chain"),
    [
        ('shear_stiffness = "120 MN"', Chain((Segment(30.0, 300.0, E * 0.01, 120e6),))),
        ('rotary_inertia_per_length = "0.25 t m"', Chain((Segment(30.0, 300.0, E * 0.01, inf, 250.0),))),
        (
            '[[tower.bodies]]\nheight = "30 m"\nmass = "2 t"',
            Chain((Segment(30.0, 300.0, E * 0.01),), {1: EndBody(2e3)}),
        ),
        (
            '[foundation]\nrotation_stiffness = "2 GN m/rad"',
            Chain((Segment(30.0, 300.0, E * 0.01),), foundation=Foundation(2e9)),
        ),
        (
            '[foundation]\ntranslation_stiffness = "2 GN/m"',
            Chain((Segment(30.0, 300.0, E * 0.01),), foundation=Foundation(inf, 2e9)),
        ),
    ],
)
def test_each_effect_of_a_uniform_tower_makes_it_a_chain(write_tower, key, chain):
    case = load_case(write_tower(UNIFORM + key + "\n"))
    same(kept_tower(case.checked), chain)
    assert crane_of(case.checked).tower == kept_tower(case.checked)


@pytest.mark.parametrize("nothing", ["", "[foundation]\n", "bodies = []\n", "segments = []\n", 'beam = "stated"\n'])
def test_a_plain_tower_is_a_beam(write_tower, nothing):
    case = load_case(write_tower(UNIFORM + nothing))
    assert kept_tower(case.checked) == Beam(30.0, 300.0, 210e9, 0.01)


def test_one_segment_is_a_chain_all_the_same(write_tower):
    same(kept_tower(load_case(write_tower(ONE_SEGMENT)).checked), Chain((Segment(30.0, 300.0, E * 0.01),)))


@pytest.mark.parametrize(("taper", "powers"), [("legs", (0, 2, 0)), ("wedge", (1, 3, 1)), ("cone", (2, 4, 2))])
def test_laws_of_taper(write_tower, taper, powers):
    tower = ONE_SEGMENT + f'top_breadth_ratio = 0.5\ntaper = "{taper}"\n'
    (segment,) = kept_tower(load_case(write_tower(tower)).checked).segments
    assert (segment.mass_power, segment.bending_power, segment.shear_power) == powers
    assert segment.end_ratio == 0.5


def test_bodies_at_one_height_are_one_body(write_tower):
    two = "[[tower.bodies]]\nheight = 30\nmass = 1e3\n[[tower.bodies]]\nheight = 30\nmass = 3e3\noffset = 2\n"
    chain = kept_tower(load_case(write_tower(UNIFORM + two)).checked)
    assert chain.bodies == {1: EndBody(4e3, 1e3 * 1.5**2 + 3e3 * 0.5**2, 1.5)}


# Which beam a lattice gives


def test_a_lattice_alone_is_a_shear_flexible_tower(write_tower):
    stiffness = COLUMN.bending_stiffness.value, COLUMN.shear_stiffness.value, 300.0 * 0.85**2
    same(kept_tower(load_case(write_tower(LACED)).checked), Chain((Segment(30.0, 300.0, *stiffness),)))
    case = load_case(write_tower(LACED), ["crane.tower.beam=shear-flexible"])
    assert kept_tower(case.checked).segments[0].shear_stiffness == pytest.approx(stiffness[1], rel=1e-14)
    assert lattice_of(case.crane).panel_height == 1.4


def test_a_lattice_beside_a_stated_inertia_is_a_check_unless_asked_for(write_tower):
    path = write_tower(UNIFORM + "[tower.lattice]\n" + MEMBERS)
    assert kept_tower(load_case(path).checked) == Beam(30.0, 300.0, 210e9, 0.01)
    assert kept_tower(load_case(path, ["crane.tower.beam=stated"]).checked).second_moment_of_area == 0.01
    euler = kept_tower(load_case(path, ["crane.tower.beam=euler"]).checked)
    assert euler.bending_stiffness == pytest.approx(COLUMN.bending_stiffness.value, rel=1e-14)
    equivalent = kept_tower(load_case(path, ["crane.tower.beam=code-equivalent"]).checked)
    wanted = COLUMN.equivalent_second_moment_of_area(30.0).value
    assert equivalent.second_moment_of_area == pytest.approx(wanted, rel=1e-14)
    flexible = kept_tower(load_case(path, ["crane.tower.beam=shear-flexible"]).checked)
    assert flexible.segments[0].bending_stiffness == pytest.approx(COLUMN.bending_stiffness.value, rel=1e-14)


def test_laced_segments_follow_the_tower_and_stated_ones_do_not(write_tower):
    case = load_case(write_tower(SEGMENTS), ["crane.tower.beam=euler"])
    assert [segment.shear_stiffness for segment in kept_tower(case.checked).segments] == [150e6, inf, inf]
    tower = case.crane.tower
    assert [beam_choice(tower, segment) for segment in tower.segments] == ["stated", "euler"]


def test_what_a_run_rests_on(write_tower):
    lattice = "[tower.lattice]\n" + MEMBERS.replace('"1.4 m"', '{ value = "1.4 m", assumed = "not printed" }')
    tower = UNIFORM.replace('"0.01 m^4"', '{ value = "0.01 m^4", assumed = "a guess" }') + lattice
    path = write_tower(tower, ('counterweight = "10 t"', 'counterweight = "10 t"\n' + FLEXIBLE.replace(
        '"0.002 m^4"', '{ value = "0.002 m^4", assumed = "a guess" }')))  # fmt: skip
    stated, members = "crane.tower.second_moment_of_area", "crane.tower.lattice.panel_height"
    bends = "crane.counter_jib.second_moment_of_area"
    assert {a.key for a in load_case(path).assumed} == {stated, members, bends}
    assert {a.key for a in rests_on(load_case(path))} == {stated, bends}
    rigid = ["model.counter_jib_vertical_modes=0"]
    assert [a.key for a in rests_on(load_case(path, rigid))] == [stated]
    assert [a.key for a in rests_on(load_case(path, [*rigid, "crane.tower.beam=euler"]))] == [members]


def test_assumed_values_anywhere_in_a_tower_are_listed(write_tower):
    def mark(match):
        return f'{match[1]} = {{ value = {match[2]}, assumed = "a guess" }}\n'

    tower = re.sub(r"(\w+) = (.*)\n", mark, TIED)
    case = load_case(write_tower(tower))
    same(kept_tower(case.checked), kept_tower(load_case(write_tower(TIED)).checked))
    keys = {a.key for a in case.assumed}
    assert len(keys) == len(case.assumed) == TIED.count(" = ")
    assert {
        "crane.tower.segments.1.lattice.lacing", "crane.tower.segments.0.taper", "crane.tower.bodies.1.offset",
        "crane.foundation.rotation_stiffness", "crane.tower.shear_theory", "crane.foundation.block.offset",
        "crane.tower.collars.0.height",
    } <= keys  # fmt: skip
    # A run in the plane twists no collar.
    assert rests_on(case) == tuple(a for a in case.assumed if not a.key.endswith("torsional_stiffness"))
    rigid = load_case(write_tower(UNIFORM + '[foundation.block]\nmass = { value = "40 t", assumed = "a guess" }\n'))
    assert len(rigid.assumed) == 1
    assert rests_on(rigid) == ()
