"""Rigid members against the stiff limit, and the study of parameters on a crane small enough to check."""

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples.lab_crane import BASIC, BUILDERS, LOAD, crane, motions

from towercrane.cranes.slewing.model import LumpedModel
from towercrane.cranes.slewing.parameters import BasicParameters
from towercrane.cranes.slewing.reduce import make_rigid
from towercrane.kernels.elastic_rope import Elasticity
from towercrane.simulation.simulate import simulate
from towercrane.studies.sensitivity import parameters_of, study

MEMBERS = [spring.name for spring in crane("multi-mass").crane.springs]


def stiffer(model, member, factor):
    springs = tuple(
        dataclasses.replace(s, stiffness=s.stiffness * (factor if s.name == member else 1.0))
        for s in model.crane.springs
    )
    return dataclasses.replace(model, crane=dataclasses.replace(model.crane, springs=springs))


@pytest.mark.parametrize("member", MEMBERS)
def test_a_rigid_member_is_the_limit_of_a_stiff_one(member):
    model = crane("multi-mass")
    rigid = dataclasses.replace(model, crane=make_rigid(model.crane, [member]))
    assert rigid.coordinates == model.coordinates - 1

    def gap(factor):
        # Undamped members of that stiffness would ring; one second covers the start.
        runs = [
            simulate(m, motions(), 1.5, rtol=1e-9, atol=1e-11, output_step=0.05)
            for m in (rigid, stiffer(model, member, factor))
        ]
        return max(np.max(abs(runs[0][n].values - runs[1][n].values)) for n in ("sway_radial", "sway_tangential"))

    gaps = [gap(30.0), gap(300.0)]
    assert gaps[0] < 3e-4
    assert 7.0 < gaps[0] / gaps[1] < 14.0


def test_a_rigid_rope_is_the_limit_of_a_stiff_one():
    model = crane("basic")
    rigid = dataclasses.replace(model, crane=make_rigid(model.crane, ["rope"]))
    stiff = dataclasses.replace(model, crane=dataclasses.replace(model.crane, rope=Elasticity(1.5e8)))
    runs = [simulate(m, motions(), 0.5, output_step=0.05) for m in (rigid, stiff)]
    assert_allclose(runs[0]["sway_radial"], runs[1]["sway_radial"], atol=2e-5)


def test_what_is_read_off_a_rigid_member_is_gone():
    assert "jib_moment_vertical" not in make_rigid(crane("enhanced").crane, ["jib_vertical"]).linear_outputs
    with pytest.raises(ValueError, match=r"wanted springs among tower_x.*got 'boom'"):
        make_rigid(crane("enhanced").crane, ["boom"])


@pytest.fixture(scope="module")
def found():
    fields = {f.name: getattr(BASIC, f.name) for f in dataclasses.fields(BasicParameters)}
    names = ["drive_stiff_stiffness", "stiffness_jib_vertical", "damping_jib_vertical", "drive_corner"]
    return study(
        BasicParameters(**fields),
        lambda p: LumpedModel(BUILDERS["basic"](p), LOAD),
        motions(2.0, 3.0),
        10.0,
        vary=names,
        percent=(0, 50, 100, 150, 200),
    )


def test_drive_matters_and_vertical_damping_does_not(found):
    ranked = [entry["parameter"] for entry in found.influence]
    assert set(ranked[:2]) == {"drive_stiff_stiffness", "drive_corner"}
    assert ranked[-1] == "damping_jib_vertical"
    for entry in found.influence:
        for name, near in entry["near"].items():
            assert 0.0 <= near <= entry["far"][name]


def test_nominal_rows_are_the_nominal_run(found):
    for name in found.data.data_vars:
        nominal = found.data[name].sel(percent=100.0).values
        assert np.all(nominal == nominal[0])
        assert found.data[name].dims == ("parameter", "percent", "time")


def test_reduced_crane_keeps_its_promise(found):
    assert "rope" in found.reduced["rigid"]
    assert "jib_vertical" not in found.reduced["rigid"]  # the vertical moment is read off it
    assert found.degrees_of_freedom == 7
    assert found.reduced["degrees_of_freedom"] == 7 - len(found.reduced["rigid"])
    singles = {m["member"]: m["change"] for m in found.members}
    for name, change in found.reduced["change"].items():
        assert change < 1.5 * sum(singles[m][name] for m in found.reduced["rigid"]) + 1e-3
    assert found.reduced["cost"] < 0.8


def test_parameters_are_the_positive_numbers_that_match():
    fields = {f.name: getattr(BASIC, f.name) for f in dataclasses.fields(BasicParameters)}
    parameters = BasicParameters(**fields)
    assert parameters_of(parameters, ["stiffness_*"]) == [n for n in fields if n.startswith("stiffness_")]
    assert "gravity" not in parameters_of(parameters)
    assert "friction_law" not in parameters_of(parameters)


def test_unknown_names_are_refused():
    fields = {f.name: getattr(BASIC, f.name) for f in dataclasses.fields(BasicParameters)}
    parameters = BasicParameters(**fields)

    def build(p):
        return LumpedModel(BUILDERS["basic"](p), LOAD)

    with pytest.raises(ValueError, match="vary: wanted parameters that are not zero, got nonsense"):
        study(parameters, build, motions(), 1.0, vary=["nonsense"])
    with pytest.raises(ValueError, match="outputs: wanted some of"):
        study(parameters, build, motions(), 1.0, vary=[], outputs=["nonsense"])
