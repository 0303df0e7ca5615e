"""What commands compile before they begin: every module that they need, in a cache that no change leaves stale."""

import importlib.util
import subprocess
import sys
from pathlib import Path
from threading import Thread

import pytest
from numba import types

import modal
from modal.compiler import compiled, folder
from towercrane.cases.case import load_case
from towercrane.cranes.registry import KINDS
from towercrane.kernels.compilation import compile_kernels, missing_kernels

TOP = Path(modal.__file__).parents[1]
PACKAGES = [TOP / "modal", TOP / "towercrane"]


def test_kernels_are_in_the_rooms_whose_sources_name_the_cache():
    makers = [
        source.relative_to(TOP).as_posix()
        for package in PACKAGES
        for source in package.rglob("*.py")
        if "compiled import kernel" in source.read_text()
    ]
    assert all(maker.startswith(folder.ROOMS) for maker in makers)
    assert all((TOP / room).is_dir() for room in folder.ROOMS)


def test_a_change_of_a_source_names_another_cache(tmp_path, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    for name in ("modal/compiler", "towercrane/kernels"):
        (tmp_path / name).mkdir(parents=True)
    kernel, layout = tmp_path / "modal/roots.py", tmp_path / "towercrane/kernels/layout.py"
    monkeypatch.setattr(folder, "__file__", str(tmp_path / "modal/compiler/folder.py"))
    found = []
    for changed in (kernel, layout, kernel):
        changed.write_text(f"x = {len(found)}\n")
        found.append(folder.cache_folder.__wrapped__())
    assert len(set(found)) == 3
    assert folder.cache_folder.__wrapped__() == found[-1]


REST = RUN = ["modal.beams.roots"]
STEPPER = "towercrane.simulation.stepper"
STRUCTURE = ["modal.structures.kernels.structure", "modal.structures.kernels.shapes"]


@pytest.mark.parametrize(
    ("name", "use", "modules"),
    [
        ("qtz5613/condition-3", "run", [*RUN, STEPPER]),
        ("qtz5613/manoeuvre", "run", [*RUN, STEPPER]),
        ("towers/stepped", "run", [*RUN, *STRUCTURE, STEPPER]),
        ("slewing/basic/example-1", "run", [STEPPER]),
        ("jib-crane/plan", "run", [STEPPER]),
        ("overhead-crane/travel", "run", [STEPPER]),
        ("qtz5613/manoeuvre", "modes", REST),
        ("qtz5613/condition-3", "modes", [*REST, *STRUCTURE]),
        ("qtz5613/condition-3", "map", STRUCTURE),
        ("qtz5613/condition-3", "lattice", STRUCTURE[:1]),
    ],
)
def test_a_case_names_what_a_use_of_its_crane_needs(name, use, modules):
    case = load_case(name, [])
    assert list(KINDS[case.kind].kernels(case.checked, use)) == modules


def test_all_modules_of_kernels_are_there():
    lanes = KINDS["tower"].kernels(load_case("qtz5613/condition-3").checked, "lanes")
    others = [STEPPER]
    assert all(importlib.util.find_spec(module) for module in (*RUN, *REST, *STRUCTURE, *lanes, *others))


def test_what_is_compiled_here_or_beside_is_missing_no_more(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    # This process has compiled its own kernels elsewhere: a fresh one finds them missing, and makes them.
    code = (
        "from towercrane.kernels.compilation import compile_kernels as c, missing_kernels as m\n"
        "modules = 'modal.beams.roots', 'towercrane.simulation.stepper'\n"
        "before = m(*modules); c(*before); print(len(before), len(m(*modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2", "0"]


@pytest.mark.parametrize(
    ("modules", "here", "beside"),
    [
        (["modal.beams.integrals", STEPPER], ["modal.beams.integrals"], [STEPPER]),
        ([*RUN, *STRUCTURE, STEPPER], STRUCTURE, [STEPPER]),
        ([STEPPER], [STEPPER], None),
    ],
)
def test_exact_structures_share_a_process(modules, here, beside, monkeypatch):
    imported, started = [], []
    monkeypatch.setattr("towercrane.kernels.compilation.is_compiled", lambda module: module == "modal.beams.roots")
    monkeypatch.setattr("towercrane.kernels.compilation.import_module", imported.append)
    monkeypatch.setattr(
        "towercrane.kernels.compilation._started", lambda modules: started.append(modules) or Thread()
    )
    monkeypatch.setattr(Thread, "join", lambda self: None)
    compile_kernels(*missing_kernels(*modules))
    assert imported == here
    assert started == ([] if beside is None else [beside])


def _doubled(x):
    return x + x


def test_what_kernels_call_is_python_to_python_until_it_has_a_door():
    inner, outer = compiled.kernel()(_doubled), compiled.kernel(python_entry=True)(_doubled)
    assert inner("a") == "aa"
    assert not inner.signatures
    assert outer(1.5) == inner(1.5) == 3.0
    assert outer.signatures
    caller = compiled.kernel(types.float64(types.float64))(lambda x: inner(x) + 1.0)
    assert caller(1.5) == 4.0
    assert inner.signatures
    # What a kernel has compiled for itself is no door.
    assert inner(1.5) == 3.0


def test_nothing_beside_starts_no_process(monkeypatch):
    monkeypatch.setattr("multiprocessing.get_context", None)
    compile_kernels("towercrane.kernels.polynomial")
