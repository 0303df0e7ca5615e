"""What numba promises to nobody and the compiler's tools use all the same: a release that changes it fails here.

A failure names the part and who rests on it. Mend that, then raise the bound on numba in pyproject.toml.
"""

import inspect
import tomllib
from functools import reduce
from importlib import import_module
from pathlib import Path

import numba
import numpy as np
import pytest
from numba import types
from numba.core import caching, config
from numba.extending import intrinsic

from modal.compiler import compiled, kernel_cache
from modal.compiler.folder import is_compiled

CACHE, KERNELS = "modal.compiler.kernel_cache", "modal.compiler.compiled"
LANES = "towercrane.kernels.vector and arrays"
STRAIGHT = "towercrane.kernels.straight"

FUNCTIONS = [
    ("numba.core.caching", "FunctionCache", "py_func", CACHE),
    ("numba.core.caching", "FunctionCache.load_overload", "self sig target_context", CACHE),
    ("numba.core.caching", "FunctionCache.save_overload", "self sig data", CACHE),
    ("numba.core.caching", "FunctionCache._index_key", "self sig codegen", CACHE),
    ("numba.core.caching", "FunctionCache.flush", "self", CACHE),
    ("numba.core.caching", "IndexDataCacheFile", "cache_path filename_base source_stamp", CACHE),
    ("numba.core.caching", "IndexDataCacheFile.save", "self key data", CACHE),
    ("numba.core.caching", "IndexDataCacheFile._load_index", "self", CACHE),
    ("numba.core.caching", "IndexDataCacheFile._load_data", "self name", CACHE),
    ("numba.core.caching", "IndexDataCacheFile._data_path", "self name", CACHE),
    ("numba.core.caching", "IndexDataCacheFile._open_for_write", "self filepath", CACHE),
    ("numba.core.dispatcher", "Dispatcher.compile", "self sig", KERNELS),
    ("numba.core.dispatcher", "Dispatcher.disable_compile", "self val", KERNELS),
    ("numba.core.base", "BaseContext.get_dummy_value", "self", STRAIGHT),
    ("numba.np.arrayobj", "make_array", "array_type", STRAIGHT),
    ("numba.np.arrayobj", "populate_array", "array data shape strides itemsize meminfo parent", LANES),
    ("numba.core.cgutils", "unpack_tuple", "builder tup count", STRAIGHT),
    ("numba.core.cgutils", "get_or_insert_function", "module fnty name", STRAIGHT),
    ("numba.core.cgutils", "alloca_once", "builder ty size name zfill", STRAIGHT),
    ("numba.core.cgutils", "alloca_once_value", "builder value name zfill", STRAIGHT),
    ("numba.core.cgutils", "for_range", "builder count start intp", STRAIGHT),
    ("numba.core.types", "Type.can_convert_from", "self typingctx other", LANES),
    ("numba.core.base", "BaseContext.get_function", "self fn sig _firstcall", STRAIGHT),
]


def changed(part, user, wanted, got):
    return (
        f"numba {numba.__version__} has changed {part}: wanted {wanted}, got {got}. {user} rests on it: mend that, "
        "then raise the bound on numba in pyproject.toml"
    )


def doubled(x):
    return x + x


@pytest.mark.parametrize(("module", "name", "wanted", "user"), FUNCTIONS, ids=[row[1] for row in FUNCTIONS])
def test_private_function_takes_what_it_is_given(module, name, wanted, user):
    try:
        found = reduce(getattr, name.split("."), import_module(module))
    except (ImportError, AttributeError):
        pytest.fail(changed(f"{module}.{name}", user, wanted, "nothing: it is gone"))
    got = " ".join(inspect.signature(found).parameters)
    assert got == wanted, changed(f"{module}.{name}", user, wanted, got)


def test_a_cache_has_the_parts_that_ours_replaces(tmp_path, monkeypatch):
    monkeypatch.setattr(config, "CACHE_DIR", str(tmp_path))
    cache = caching.FunctionCache(doubled)
    for name in ("_impl.locator.get_source_stamp", "_impl.filename_base", "_cache_path", "_cache_file", "cache_path"):
        try:
            reduce(getattr, name.split("."), cache)
        except AttributeError:
            pytest.fail(changed(f"the attribute {name} of a FunctionCache", CACHE, "it", "nothing"))
    kind = type(cache._cache_file)
    assert kind is caching.IndexDataCacheFile, changed("a cache's file", CACHE, "an IndexDataCacheFile", kind)
    for name in ("_index_path", "_version", "_source_stamp"):
        assert hasattr(cache._cache_file, name), changed(f"{name} of an IndexDataCacheFile", CACHE, "it", "nothing")


def test_config_cache_dir_names_the_folder_and_files_are_called_by_room_and_module(tmp_path, monkeypatch):
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr("modal.compiler.folder.cache_folder", lambda: tmp_path)
    compiled.kernel(types.float64(types.float64))(doubled)
    found = [path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.nbi")]
    said = changed(
        "config.CACHE_DIR or the names of cached files", "modal.compiler.folder", "room_*/module.*.nbi", found
    )
    assert is_compiled(f"tests.{Path(__file__).parent.name}.{Path(__file__).stem}"), said


def test_a_dispatcher_has_what_kernels_use_and_may_change_its_class(tmp_path, monkeypatch):
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path)
    made = compiled.kernel(types.float64(types.float64))(doubled)
    for name in ("py_func", "signatures", "_cache", "stats.cache_hits"):
        try:
            reduce(getattr, name.split("."), made)
        except AttributeError:
            pytest.fail(changed(f"the attribute {name} of compiled functions", KERNELS, "it", "nothing"))
    kept = type(made._cache)
    assert kept is kernel_cache.KernelCache, changed("_cache of compiled functions", KERNELS, "ours", kept)
    inner = compiled.kernel()(doubled)
    assert inner("a") == "aa", changed("the class of compiled functions", KERNELS, "calls that we define", "others")


def test_without_reference_counts_what_allocates_is_refused():
    """Right-hand sides take a third longer with them."""

    def allocates(n):
        return np.zeros(n)[0]

    with pytest.raises(numba.core.errors.NumbaError):
        numba.njit(_nrt=False)(allocates).compile((types.int64,))
    code = {}
    for counts in (True, False):
        made = numba.njit(_nrt=counts)(lambda array: array[0] + array[1])
        made.compile((types.float64[::1],))
        code[counts] = next(iter(made.inspect_llvm().values()))
    found = {counts: own.count("@NRT_") for counts, own in code.items()}
    said = changed("the option _nrt of njit", KERNELS, "counts of references with it alone", found)
    assert found[True], said
    assert not found[False], said


def test_doors_can_be_left_out():
    made = numba.njit(no_cpython_wrapper=True, no_cfunc_wrapper=True)(lambda x: x + 1.0)
    made.compile((types.float64,))
    code = next(iter(made.inspect_llvm().values()))
    said = changed("the options no_cpython_wrapper and no_cfunc_wrapper", KERNELS, "no wrappers", "cpython or cfunc")
    assert "cpython" not in code, said
    assert "cfunc." not in code, said


def test_an_intrinsic_is_called_by_the_signature_that_it_states():
    """Traced functions take as many arguments as they say, whatever Python's own signature is."""

    def typed(_context, *kinds):
        return types.float64(*kinds), lambda _context, _builder, _signature, arguments: arguments[1]

    names = [inspect.Parameter(name, inspect.Parameter.POSITIONAL_ONLY) for name in ("context", "a", "b")]
    typed.__signature__ = inspect.Signature(names)
    second = intrinsic(typed)
    found = numba.njit(lambda x, y: second(x, y))(1.0, 2.0)
    assert found == 2.0, changed("numba.extending.intrinsic", STRAIGHT, "a call by __signature__", found)


def test_lane_vectors_may_be_made_of_numbers():
    from numba.core.typeconv.castgraph import Conversion

    assert hasattr(Conversion, "safe"), changed("castgraph.Conversion", LANES, "safe", list(Conversion))


def test_numba_has_an_upper_bound_for_what_is_tested_here():
    stated = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text("utf-8"))
    (bound,) = [need for need in stated["project"]["dependencies"] if need.startswith("numba")]
    assert ",<" in bound
    newest = tuple(map(int, bound.partition(",<")[2].split(".")))
    assert tuple(map(int, numba.__version__.split(".")[:2])) < newest
