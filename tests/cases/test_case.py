"""The door for case files: what it reads."""

import json
import math
import subprocess
import sys

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from samples.case_files import CASE, CRANE, only_fault

from modal.beams.beam import Beam
from towercrane.cases.case import Assumption, CaseError, Fault, load_case
from towercrane.cases.kinds import EveryKey
from towercrane.cases.models import motions_of
from towercrane.cranes.parts.load import load_of
from towercrane.cranes.tower.file.build import crane_of
from towercrane.cranes.tower.file.effects import kept_tower
from towercrane.cranes.tower.file.members import jib_of, lattice_of
from towercrane.cranes.tower.file.requests import modes_of
from towercrane.schema.units import to_si


def test_values_are_si_and_defaults_hold(write):
    case = load_case(write())
    assert (case.name, case.title, case.path.name) == ("case", "A case", "case.toml")
    assert case.crane.tower.height == 30.0
    assert case.crane.counter_jib.counterweight == 10e3
    assert (case.crane.gravity, case.crane.source, case.crane.tower.lattice) == (9.81, "", None)
    assert (case.payload.mass, case.payload.rope_damping, case.payload.drag_area) == (800.0, 0.0, 0.0)
    model, modes = case.checked.model, modes_of(case.checked, motions_of(case)["trolley"])
    assert (model.tower_modes, model.jib_vertical_modes, model.weight_softening) == (2, 3, False)
    assert (model.tower_damping_ratio, model.jib_vertical_damping_ratio) == (0.0, 0.0)
    assert (case.start.state, case.start.sway_radial) == ("equilibrium", None)
    assert (case.run.duration, case.run.output_step) == (60.0, 0.05)
    assert (case.solver.method, case.solver.rtol, case.solver.atol) == ("dop853", 1e-8, 1e-10)
    assert (modes.count, modes.trolley_positions, modes.elements) == (4, pytest.approx((5.0, 30.0)), 32)
    assert case.assumed == ()


def test_every_optional_key_is_read(write):
    options = """
[model]
tower_modes = 0
jib_vertical_modes = 14
weight_softening = true
tower_damping_ratio = "2 %"
jib_vertical_damping_ratio = 0.01
[start]
state = "zero"
sway_radial = "-5 deg"
[solver]
method = "scipy-radau"
rtol = 1e-5
atol = 1e-7
[modes]
count = 6
trolley_positions = ["5 m", 30]
elements = 64
"""
    path = write(
        ('mass = "800 kg"', 'mass = 800\nrope_damping = "3 N m s/rad"\ndrag_area = "2 m^2"'),
        case_text=CASE + 'output_step = "20 ms"' + options,
        crane=[('name = "Small"', 'name = "Small"\ngravity = "981 cm/s^2"\nsource = "mine"')],
    )
    case = load_case(path)
    assert (case.payload.mass, case.payload.rope_damping, case.payload.drag_area) == (800.0, 3.0, 2.0)
    model, modes = case.checked.model, modes_of(case.checked, motions_of(case)["trolley"])
    assert (model.tower_modes, model.jib_vertical_modes, model.weight_softening) == (0, 14, True)
    assert model.tower_damping_ratio == pytest.approx(0.02)
    assert model.jib_vertical_damping_ratio == 0.01
    assert case.start.sway_radial == pytest.approx(math.radians(-5))
    assert case.start.state == "zero"
    assert case.run.output_step == pytest.approx(0.02)
    assert (case.solver.method, case.solver.rtol, case.solver.atol) == ("scipy-radau", 1e-5, 1e-7)
    assert (modes.count, modes.trolley_positions, modes.elements) == (6, (5.0, 30.0), 64)
    assert case.crane.gravity == pytest.approx(9.81)


def test_domain_objects(write):
    case = load_case(write())
    crane = crane_of(case.checked)
    assert crane.tower == kept_tower(case.checked) == Beam(30.0, 300.0, to_si("210 GPa", "Pa"), 0.01)
    assert crane.jib == jib_of(case.crane) == Beam(40.0, 100.0, to_si("210 GPa", "Pa"), 0.003)
    assert (crane.counter_jib_length, crane.counter_jib_mass_per_length) == (10.0, 150.0)
    assert (crane.name, crane.counterweight, crane.trolley_mass, crane.gravity) == (
        "Small",
        10e3,
        300.0,
        9.81,
    )
    assert load_of(case.payload).mass == 800.0
    trolley, rope = motions_of(case)["trolley"], motions_of(case)["rope"]
    assert float(trolley(0.0)) == 5.0
    assert float(trolley(8.0, 1)) == pytest.approx(0.8)
    assert trolley.duration == pytest.approx(25 / 0.8 + 8.0)
    assert float(rope(17.0)) == 12.0
    assert lattice_of(case.crane) is None


def test_an_inline_crane_needs_no_file(write):
    inline = "[crane]\n" + CRANE.replace("[", "[crane.")
    path = write(('crane = "crane.toml"', ""), case_text=CASE + inline)
    (path.parent / "crane.toml").unlink()
    assert load_case(path).crane.jib.length == 40.0
    path.write_text(path.read_text().replace('height = "30 m"', 'heigth = "30 m"'))
    fault = only_fault(path)
    assert (fault.file, fault.key) == (str(path), "crane.tower.heigth")


def test_assumed_values_are_listed_as_written_the_cranes_first(write):
    path = write(
        ('"800 kg"', '{ value = "800 kg", assumed = "a guess" }'),
        crane=[
            ('"40 m"', '{ value = "40 m", source = "data sheet" }'),
            ('"0.003 m^4"', '{ value = 0.003, assumed = "not printed" }'),
        ],
    )
    case = load_case(path)
    assert case.assumed == (
        Assumption("crane.jib.second_moment_of_area", 0.003, "not printed"),
        Assumption("payload.mass", "800 kg", "a guess"),
    )
    assert case.crane.jib.length == 40.0
    assert case.as_written["crane"]["jib"]["length"] == {"value": "40 m", "source": "data sheet"}
    assert json.loads(json.dumps(case.as_written)) == case.as_written
    # A value given on the command line is no longer the file's assumption.
    assert [a.key for a in load_case(path, ["payload.mass=900 kg"]).assumed] == ["crane.jib.second_moment_of_area"]


@pytest.mark.parametrize(
    ("table", "key", "words"),
    [
        ('{ value = "800 kg", asumed = "x" }', "payload.mass.asumed", ("unknown", '"assumed"')),
        ('{ value = "800 kg", assumed = "" }', "payload.mass.assumed", ("why", '""')),
        ('{ value = "800 kg", assumed = true }', "payload.mass.assumed", ("why", "true")),
        ('{ assumed = "x" }', "payload.mass", ("a mass", "a table with assumed")),
    ],
)
def test_provenance_faults(write, table, key, words):
    fault = only_fault(write(('"800 kg"', table)))
    assert fault.key == key
    assert all(w in str(fault) for w in words)


def test_importing_the_door_loads_neither_units_nor_schema():
    code = "import sys, towercrane.cases.case; print({'pint', 'pydantic', 'numpy'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


VALUES = st.recursive(
    st.one_of(
        st.none().map(lambda _: "nan"),
        st.booleans().map(lambda b: str(b).lower()),
        st.integers().map(str),
        st.floats().map(lambda x: repr(x)),
        st.text(st.characters(codec="utf-8", exclude_categories=("C",)), max_size=8).map(
            lambda s: json.dumps(s, ensure_ascii=False)
        ),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3).map(lambda v: f"[{', '.join(v)}]"),
        st.dictionaries(st.sampled_from(["value", "assumed", "shape", "start", "x"]), inner, max_size=3).map(
            lambda d: "{ " + ", ".join(f"{k} = {v}" for k, v in d.items()) + " }"
        ),
    ),
    max_leaves=4,
)


@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(["qtz5613/condition-3", "towers/tapered"]),
    st.sampled_from([*sorted(EveryKey()), "x", "crane.x.y", "motion.trolley.start.x"]),
    VALUES,
)
def test_any_value_at_any_key_is_read_or_explained(name, key, value):
    for listed in ("segments", "bodies"):
        key = key.replace(f"tower.{listed}.", f"tower.{listed}.1.")
    try:
        load_case(name, [f"{key}={value}"])
        faults = [Fault("none", "", "none", "none")]
    except CaseError as error:
        faults = error.faults
    assert faults
    assert all(f.file and f.wanted and f.got for f in faults)
