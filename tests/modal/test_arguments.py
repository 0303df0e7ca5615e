"""Arguments that are no lengths, masses, stiffnesses or counts: one ValueError, what was wanted and what came."""

from dataclasses import fields, replace
from functools import partial
from math import inf, nan

import numpy as np
import pytest

import modal
from modal import (
    Beam,
    Chain,
    Collar,
    ColumnTruss,
    CraneFrame,
    EndBody,
    Foundation,
    JibLattice,
    LacedColumn,
    LatticeJib,
    Pendulum,
    Segment,
    Shaft,
    StructureElements,
    cantilever_modes,
    chain_frequencies,
    chain_structure,
    characteristic_roots,
    compare_lattice_models,
    crane_structure,
    finite_element_frequencies,
    finite_element_structure_frequencies,
    torsion_modes,
)
from modal.lattices.lattice_taper import column_segments
from modal.structures.chain_modes import chain_modes

BEAM = Beam(30.0, 300.0, 2e11, 0.01)
CHAIN = Chain((Segment(30.0, 300.0, 2e9),), {1: EndBody(1e4, 1e5)})
COLUMN = LacedColumn(0.006, 1.6, 1.0, 0.001, 2e11, "X", 0.001)
FRAME = CraneFrame(CHAIN, Chain((Segment(40.0, 100.0, 6e8),)), None, 300.0, 1000.0, 10.0)
RIGID = replace(FRAME, jib=None)
SHAFT = Shaft(30.0, 100.0, 1e8)
STRUCTURE = chain_structure(CHAIN)
TRUSS = ColumnTruss(COLUMN, 4.0, 300.0)
LATTICE = JibLattice(1.5, 1.4, 4e-3, 8e-3, 2.0, 1e-3, 1e-3, 2e11, "X", "X", 1e-3, 1e-3)
JIB = LatticeJib(((8.0, LATTICE),))
OBJECTS = [
    BEAM, EndBody(), CHAIN.segments[0], CHAIN, Foundation(1e9, 1e9), Collar(1e7), Pendulum(1e3, 10.0), FRAME, COLUMN,
    SHAFT, TRUSS, LATTICE, LATTICE.section(1.5),
]  # fmt: skip
INFINITE = {"mass", "rotary_inertia", "shear_stiffness", "rotation_stiffness", "translation_stiffness"}
SIGNED = {"EndBody.offset", "Segment.shear_power", "Segment.coupling", "Chain.axial_load", "Foundation.coupling"}
NUMBERS = [
    pytest.param(made, field.name, id=f"{type(made).__name__}.{field.name}")
    for made in OBJECTS
    for field in fields(made)
    if type(getattr(made, field.name)) is float
]
COUNTS = {
    "cantilever_modes": partial(cantilever_modes, BEAM),
    "chain_frequencies": partial(chain_frequencies, CHAIN),
    "chain_modes": partial(chain_modes, CHAIN),
    "characteristic_roots": partial(characteristic_roots, 1.0, 1.0),
    "finite_element_frequencies": partial(finite_element_frequencies, BEAM),
    "finite_element_structure_frequencies": partial(finite_element_structure_frequencies, STRUCTURE),
    "torsion_modes": partial(torsion_modes, SHAFT),
    "ColumnTruss": TRUSS.bending_frequencies,
    "Structure": STRUCTURE.angular_frequencies,
    "StructureElements": StructureElements(STRUCTURE, 2).angular_frequencies,
    "modes of StructureElements": StructureElements(STRUCTURE, 2).modes,
    "SpaceFrame": JIB.frame().modes,
    "SpaceBeam": JIB.beam().modes,
    "compare_lattice_models": lambda count: compare_lattice_models(COLUMN, 4.0, EndBody(), 300.0, count=count),
}
ELEMENTS = {
    "finite_element_frequencies": lambda n: finite_element_frequencies(BEAM, 1, elements=n),
    "finite_element_structure_frequencies": lambda n: finite_element_structure_frequencies(STRUCTURE, 1, elements=n),
    "StructureElements": partial(StructureElements, STRUCTURE),
    "beam of LatticeJib": JIB.beam,
}
LENGTHS = {
    "height of segment": COLUMN.segment,
    "height of column_segments": partial(column_segments, COLUMN, top_ratio=0.5),
    "height of equivalent_slenderness": COLUMN.equivalent_slenderness,
    "height of compare_lattice_models": lambda h: compare_lattice_models(COLUMN, h, EndBody(), 300.0),
    "length of LatticeJib": lambda length: LatticeJib(((length, LATTICE),)),
    "length of pieces": LATTICE.pieces,
    "length of segments": lambda length: LATTICE.segments(length, "vertical"),
    "mass_per_length of pieces": partial(LATTICE.pieces, 4.0),
    "mass_per_length of segment": partial(COLUMN.segment, 4.0),
    "mass_per_length of ColumnTruss": partial(ColumnTruss, COLUMN, 4.0),
    "top_ratio of column_segments": partial(column_segments, COLUMN, 4.0),
    "trolley_position of crane_structure": partial(crane_structure, FRAME),
    "trolley_position of crane_structure, rigid": partial(crane_structure, RIGID),
    "position of with_node": CHAIN.with_node,
    "end_inertia of torsion_modes": partial(torsion_modes, SHAFT, 1),
    "mass_ratio of characteristic_roots": lambda a: characteristic_roots(a, 1.0, 1),
    "inertia_ratio of characteristic_roots": lambda j: characteristic_roots(1.0, j, 1),
    "angular_frequency of count_below": STRUCTURE.count_below,
    "stiffness of add_unknown": partial(chain_structure(CHAIN).add_unknown, "m"),
    "stiffness of add_pendulum": lambda k: chain_structure(CHAIN).add_pendulum(k, 1.0, 0, 1),
    "mass of add_pendulum": lambda m: chain_structure(CHAIN).add_pendulum(1.0, m, 0, 1),
}
BOUNDLESS = ("ratio of characteristic_roots", "stiffness of add_unknown")
NONE_IS_MEANT = ("mass_per_length",)


def refused(argument, values, make):
    for value in values:
        with pytest.raises(ValueError, match=rf"\b{argument}: wanted .*, got ") as caught:
            make(value)
        assert str(caught.value).endswith(f"got {value!r}")


@pytest.mark.parametrize(("made", "name"), NUMBERS)
def test_every_number_is_judged_as_it_is_made(made, name):
    owner = f"{type(made).__name__}.{name}"
    wrong = [nan, -inf, "3", None, True, 1j, 10**400]
    wrong += [] if owner in SIGNED else [-1.0]
    wrong += [] if name in INFINITE and owner != "Segment.rotary_inertia" else [inf]
    wrong = [value for value in wrong if not (value is None and name in NONE_IS_MEANT and made is TRUSS)]
    refused(owner.replace(".", r"\."), wrong, lambda value: replace(made, **{name: value}))
    if made is not TRUSS:
        for value in (np.float64(1.5), np.float32(1.5), 2, np.int64(2)):
            assert getattr(replace(made, **{name: value}), name) == value


@pytest.mark.parametrize("count", COUNTS.values(), ids=COUNTS)
def test_every_count_is_a_whole_number(count):
    refused("count", (-1, 2.0, "3", None, True, nan), count)
    count(np.int64(2))


@pytest.mark.parametrize("elements", ELEMENTS.values(), ids=ELEMENTS)
def test_every_number_of_elements_is_a_whole_number(elements):
    refused("elements", (0, -1, 2.0, "3", None, True, nan), elements)
    elements(np.int64(4))


@pytest.mark.parametrize(("argument", "make"), LENGTHS.items(), ids=LENGTHS)
def test_every_number_of_a_function_is_judged(argument, make):
    wrong = [-1.0, nan, "3", True, 1j]
    wrong += [] if argument.endswith(BOUNDLESS) else [inf]
    wrong += [] if argument.startswith(NONE_IS_MEANT) else [None]
    refused(argument.split()[0], wrong, make)


def test_bodies_stand_on_whole_nodes():
    for node in (1.0, "1", True, -1, 2):
        with pytest.raises(ValueError, match=r"Chain\.bodies: wanted nodes 0 to 1, got "):
            replace(CHAIN, bodies={node: EndBody()})
    assert replace(CHAIN, bodies={np.int64(1): EndBody(5.0)}).bodies[1].mass == 5.0


def test_a_number_too_small_for_its_type_is_not_above_zero():
    with pytest.raises(ValueError, match=r"Beam\.length: wanted a positive finite number, got "):
        replace(BEAM, length=np.float32(0.0))


def test_every_public_constructor_and_function_is_looked_at():
    looked_at = {type(made).__name__ for made in OBJECTS} | {name.split()[-1] for name in (*COUNTS, *LENGTHS)}
    # What is found or raised, not given, and what takes a chain alone.
    without_numbers = {"LatticeAnswers", "LatticeModel", "Mechanism", "Modes", "TorsionModes", "Unstable"}
    assert set(modal.__all__) - looked_at == without_numbers | {"chain_structure"}
