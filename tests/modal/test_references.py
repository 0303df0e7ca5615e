"""Frequencies of a tower with a slewing part beside two independent programs, where they are installed."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose

from modal import (
    Beam,
    Chain,
    EndBody,
    Segment,
    cantilever_modes,
    chain_frequencies,
    finite_element_frequencies,
)

TOWER = Beam(23.8, 350.0, 206e9, 0.014)
SLEWING = EndBody(23972.67, 9.480729e6)
EXACT = cantilever_modes(TOWER, 4, SLEWING).frequencies_hz
ELEMENTS = finite_element_frequencies(TOWER, 4, SLEWING, elements=32) / (2.0 * np.pi)

BMI = """\
==========================   Main Input File   ==========================
Uniform tower with a rigid body on its top

--------- General parameters ---------
false     Echo
2         beam_type
0.0       rot_rpm
1.0       rpm_mult
{length}  radius
0.0       hub_rad
0.        precone
0.        bl_thp
1         hub_conn
20        modepr
t         TabDelim
f         mid_node_tw

--------- Tower-top mass properties ---------
{mass}    tip_mass
0.        cm_loc
0.        cm_axial
{inertia} ixx_tip
{inertia} iyy_tip
{inertia} izz_tip
0.        ixy_tip
0.        izx_tip
0.        iyz_tip

--------- Distributed-property identifiers ---------
1         id_mat
'sections.dat' sec_props_file

Property scaling factors
1.0       sec_mass_mult
1.0       flp_iner_mult
1.0       lag_iner_mult
1.0       flp_stff_mult
1.0       edge_stff_mult
1.0       tor_stff_mult
1.0       axial_stff_mult
1.0       cg_offst_mult
1.0       sc_offst_mult
1.0       tc_offst_mult

--------- Finite element discretization ---------
{elements} nselt
Distance of element boundary nodes from tower base
{nodes}

--------- Tower support ---------
0         tow_support

END
"""

SECTIONS = """\
Uniform sections
2         n_secs

sec_loc  str_tw  tw_iner   mass_den  flp_iner  edge_iner  flp_stff   edge_stff   tor_stff   axial_stff  cg sc tc
(-)      (deg)   (deg)     (kg/m)    (kg-m)    (kg-m)     (Nm^2)     (Nm^2)      (Nm^2)     (N)         (m) (m) (m)
0.0      0.0     0.0       {mass}    {rotary}  {rotary}   {bending}  {bending}   1e12       1e15        0.0 0.0 0.0
1.0      0.0     0.0       {mass}    {rotary}  {rotary}   {bending}  {bending}   1e12       1e15        0.0 0.0 0.0
"""


def pybmodes_frequencies(folder, elements=32):
    """Frequencies in Hz, of bending in one plane."""
    tower = pytest.importorskip("pybmodes.models", reason="pybmodes is not installed (extra: references)").Tower
    nodes = " ".join(f"{x:.12g}" for x in np.linspace(0.0, 1.0, elements + 1))
    body = {"mass": SLEWING.mass, "inertia": SLEWING.rotary_inertia}
    (folder / "tower.bmi").write_text(BMI.format(length=TOWER.length, elements=elements, nodes=nodes, **body))
    section = {"mass": TOWER.mass_per_length, "bending": TOWER.bending_stiffness, "rotary": 1e-3}
    (folder / "sections.dat").write_text(SECTIONS.format(**section))
    found = tower.from_bmi(folder / "tower.bmi").run(n_modes=12)
    return np.asarray(found.frequencies)


def exudyn_frequencies(elements=32):
    """Frequencies in Hz of ANCF cable elements in the plane with a rigid body on the last node."""
    exu = pytest.importorskip("exudyn", reason="exudyn is not installed (extra: references)")
    from exudyn import itemInterface as items

    mbs = exu.SystemContainer().AddSystem()
    h = TOWER.length / elements
    nodes = [
        mbs.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[h * i, 0.0, 1.0, 0.0])) for i in range(elements + 1)
    ]
    for near, far in pairwise(nodes):
        mbs.AddObject(
            items.ObjectANCFCable2D(
                length=h,
                massPerLength=TOWER.mass_per_length,
                bendingStiffness=TOWER.bending_stiffness,
                axialStiffness=1e4 * TOWER.bending_stiffness,
                nodeNumbers=[near, far],
            )
        )
    rigid = mbs.AddNode(items.NodeRigidBody2D(referenceCoordinates=[TOWER.length, 0.0, 0.0]))
    mbs.AddObject(items.ObjectRigidBody2D(mass=SLEWING.mass, inertia=SLEWING.rotary_inertia, nodeNumber=rigid))
    ground = mbs.AddNode(items.NodePointGround())
    at_ground = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))

    def tie(node, coordinate, other, other_coordinate):
        pair = [
            mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=n, coordinate=c))
            for n, c in ((node, coordinate), (other, other_coordinate))
        ]
        mbs.AddObject(items.CoordinateConstraint(markerNumbers=pair))

    for coordinate in (0, 1, 3):
        foot = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
        mbs.AddObject(items.CoordinateConstraint(markerNumbers=[at_ground, foot]))
    # The slope across the beam of the last node is the rotation of the body.
    for coordinate, of_body in ((0, 0), (1, 1), (3, 2)):
        tie(nodes[-1], coordinate, rigid, of_body)
    mbs.Assemble()
    frequencies, _ = mbs.ComputeODE2Eigenvalues(convert2Frequencies=True)
    return np.asarray(frequencies)


def test_pybmodes(tmp_path):
    """Cubic elements as well: the same error to the digits that rounding leaves."""
    found = pybmodes_frequencies(tmp_path)
    # Both planes of bending alike, and torsion and extension between them.
    bending = [f for f, g in pairwise(found) if abs(g / f - 1.0) < 1e-6][:4]
    assert_allclose(bending, ELEMENTS, rtol=1e-9)


def test_exudyn():
    """Its stiffness comes from numerical differences: some 1e-7 of it is rounding."""
    assert_allclose(exudyn_frequencies()[:4], ELEMENTS, rtol=6e-7)


def test_exact_and_finite_elements_of_the_same_tower():
    chain = Chain((Segment(TOWER.length, TOWER.mass_per_length, TOWER.bending_stiffness),), {1: SLEWING})
    assert_allclose(chain_frequencies(chain, 4) / (2.0 * np.pi), EXACT, rtol=1e-13)
    assert_allclose(ELEMENTS / EXACT - 1.0, [0.0, 0.0, 3.32e-7, 2.518e-6], rtol=0.01, atol=1e-9)
