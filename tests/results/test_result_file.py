"""Result files from elsewhere: looked at before they are loaded, judged before anything is drawn."""

import json

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.results import files as results
from towercrane.runs.run import run_case

KINDS = {
    "radial": "qtz5613/condition-3",
    "space": "qtz5613/manoeuvre",
    "basic": "slewing/basic/example-1",
    "jib": "jib-crane/plan",
    "overhead": "overhead-crane/travel",
}


@pytest.fixture(scope="module")
def made():
    short = ("run.duration=0.4 s", "run.output_step=0.1 s", "solver.rtol=1e-4")
    return {kind: run_case(load_case(name, short)) for kind, name in KINDS.items()}


@pytest.fixture
def path(made, tmp_path):
    results.save(made["radial"], tmp_path / "result.nc")
    return tmp_path / "result.nc"


def refused(path):
    """What `animate` says of a file, in one line and before it draws."""
    done = CliRunner().invoke(app, ["animate", str(path)])
    assert done.exit_code == 2, (done.output, done.exception)
    assert isinstance(done.exception, SystemExit)
    assert done.stdout == ""
    assert [found.name for found in path.parent.iterdir() if found.suffix == ".gif"] == []
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"{path}: ")
    return line


@pytest.mark.parametrize("kind", KINDS)
def test_what_a_run_wrote_is_filmed(kind, made, tmp_path):
    results.save(made[kind], tmp_path / "result.nc")
    done = CliRunner().invoke(app, ["animate", str(tmp_path / "result.nc"), "--frames-per-second", "5"])
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize("kind", ["soft", "external", "group", "dataset elsewhere", "virtual", "reference"])
def test_data_that_lie_elsewhere_are_refused(kind, path):
    secret = path.with_name("secret.bin")
    secret.write_bytes(np.arange(5.0).tobytes())
    with h5py.File(path, "a") as file:
        if kind == "soft":
            file["other"] = h5py.SoftLink("/sway_radial")
        elif kind == "external":
            file["other"] = h5py.ExternalLink(str(secret), "/x")
        elif kind == "group":
            file.create_group("other")
        elif kind == "dataset elsewhere":
            file.create_dataset("other", (5,), "f8", external=[(str(secret), 0, 40)])
        elif kind == "virtual":
            layout = h5py.VirtualLayout((5,), "f8")
            layout[:] = h5py.VirtualSource(str(secret), "x", (5,))
            file.create_virtual_dataset("other", layout)
        else:
            file.create_dataset("other", data=np.array([file["time"].ref], h5py.ref_dtype))
    words = {"group": "got a group", "soft": "got a link", "external": "got a link", "reference": "got others"}
    assert words.get(kind, "got some of another file") in refused(path)
    with pytest.raises(ValueError, match="wanted"):
        results.load(path)


@pytest.mark.parametrize("shape", [(4_000_000_000,), (60_000, 60_000)], ids=str)
def test_file_that_asks_for_more_than_it_holds_is_refused(shape, path):
    with h5py.File(path, "a") as file:
        file.create_dataset("other", shape, "f8", chunks=(1000,) if len(shape) == 1 else (100, 100))
    assert path.stat().st_size < 100_000
    assert "bytes of data in a file of" in refused(path)


def attribute(name, value):
    def spoil(file):
        if value is None:
            del file.attrs[name]
        else:
            file.attrs[name] = value

    return spoil


def variable(name, value):
    def spoil(file):
        stored = np.asarray(value)
        kind = h5py.string_dtype() if stored.dtype.kind == "U" else stored.dtype
        scales = [scale.name for scale in file[name].dims[0].values()] if name != "time" else []
        del file[name]
        made = file.create_dataset(
            name, data=stored.astype(object) if stored.dtype.kind == "U" else stored, dtype=kind
        )
        for scale in scales:
            made.dims[0].attach_scale(file[scale])
        for axis in range(1, stored.ndim):
            made.dims[axis].attach_scale(file["fixed_axis"])

    return spoil


TEXTS, SIZES = ("outcome", "crane", "case"), ("gravity", "output_step", "payload_mass")
ODD = [(name, value) for name in (*TEXTS, *SIZES, "end_time") for value in (None, np.arange(3.0), float("nan"))]
ODD += [(name, value) for name in SIZES for value in ("text", -9.81, 0.0, 1e300, float("inf"))]


@pytest.mark.parametrize(("name", "value"), ODD, ids=str)
def test_attributes_are_judged_before_use(name, value, path):
    with h5py.File(path, "a") as file:
        attribute(name, value)(file)
    assert f"attribute {name}: wanted" in refused(path) or name == "outcome"


@pytest.mark.parametrize("name", ["case_text", "changes", "assumed"])
@pytest.mark.parametrize("value", ["{", "3", "[[1]]", '{"crane": {}}', "[" * 50_000, 7], ids=range(6))
def test_text_that_is_no_json_of_a_run_is_refused(name, value, path):
    with h5py.File(path, "a") as file:
        attribute(name, value)(file)
    line = refused(path)
    assert "wanted" in line or "cannot be read" in line


def test_case_whose_tower_does_not_fit_itself_is_refused(path):
    with h5py.File(path, "a") as file:
        written = json.loads(file.attrs["case_text"])
        del written["crane"]["tower"]["mass_per_length"]
        file.attrs["case_text"] = json.dumps(written)
    assert "cannot be read by this version, at crane.tower" in refused(path)


ROWS = 5


@pytest.mark.parametrize(
    "name", ["time", "rope_length", "trolley_position", "payload_position", "tower_x_coordinate"]
)
@pytest.mark.parametrize(
    "value",
    [
        np.zeros(3), np.zeros((ROWS, 3)), np.zeros((ROWS, 3, 3)), np.full(ROWS, np.nan), np.full(ROWS, 1e300),
        np.array(["now"] * ROWS), np.zeros(ROWS, complex), np.zeros(ROWS, bool), np.arange(ROWS)[::-1] + 1.0,
    ],
    ids=["short", "rows of three", "matrices", "nan", "huge", "text", "complex", "booleans", "backwards"],
)  # fmt: skip
def test_variables_are_judged_before_use(name, value, path):
    fits = {"payload_position": (ROWS, 3), "tower_x_coordinate": (ROWS, 3)}
    backwards = value.dtype == float and value[0].ndim == 0 and len(value) == ROWS and value[0] == ROWS
    if fits.get(name) == value.shape or (backwards and name in ("rope_length", "trolley_position")):
        pytest.skip("values that a run may have")
    with h5py.File(path, "a") as file:
        variable(name, value)(file)
    assert "wanted" in refused(path)


def test_half_a_file_is_refused(path):
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    assert "cannot be read" in refused(path)
