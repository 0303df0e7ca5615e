"""Folders of machine code: those of other sources go when nobody has used them for long, nothing else does."""

import os
import time

import platformdirs
import pytest

from modal.compiler import folder
from modal.compiler.folder import DIGITS, KEPT, cache_folder, obstacle

DAY = 24.0 * 3600.0


@pytest.fixture
def home(tmp_path, monkeypatch):
    monkeypatch.delenv(folder.CHOSEN, raising=False)
    monkeypatch.setattr(platformdirs, "user_cache_dir", lambda *_, **__: str(tmp_path / "cache"))
    obstacle.cache_clear()
    (tmp_path / "cache").mkdir()
    yield tmp_path / "cache"
    obstacle.cache_clear()


def made(home, name, days):
    """A folder with a file in it, last used so many days ago."""
    path = home / name
    (path / "native").mkdir(parents=True)
    (path / "native" / "rhs.o").write_bytes(b"code")
    aged(path, days)
    return path


def aged(path, days):
    os.utime(path, (time.time() - days * DAY,) * 2)


def test_a_new_folder_clears_away_what_nobody_has_used_for_long(home):
    old, recent = made(home, "0" * DIGITS, KEPT + 1.0), made(home, "1" * DIGITS, KEPT - 1.0)
    others = [made(home, name, 1000.0) for name in ("results", "0" * (DIGITS - 1), "g" * DIGITS, "0" * DIGITS + "1")]
    assert obstacle(cache_folder.__wrapped__()) == ""
    assert not old.exists()
    assert recent.exists()
    assert all(list(path.rglob("*.o")) for path in others)
    assert cache_folder.__wrapped__().parent == home


def test_a_folder_that_is_there_clears_nothing_away_and_counts_as_used(home):
    own, old = cache_folder.__wrapped__(), made(home, "0" * DIGITS, KEPT + 1.0)
    own.mkdir()
    aged(own, KEPT + 1.0)
    assert obstacle(own) == ""
    assert old.exists()
    assert time.time() - own.stat().st_mtime < DAY


def test_a_folder_of_the_user_s_choice_keeps_its_neighbours(home, tmp_path):
    old = made(tmp_path / "elsewhere", "0" * DIGITS, 1000.0)
    assert obstacle(tmp_path / "elsewhere" / ("1" * DIGITS)) == ""
    assert old.exists()


def test_what_a_link_leads_to_and_what_cannot_be_removed_stay_without_a_word(home, tmp_path, monkeypatch):
    target = made(tmp_path, "target", KEPT + 1.0)
    link, stuck, old = (
        home / ("0" * DIGITS),
        made(home, "1" * DIGITS, KEPT + 1.0),
        made(home, "2" * DIGITS, KEPT + 1.0),
    )
    link.symlink_to(target, target_is_directory=True)
    monkeypatch.setattr(folder.Path, "iterdir", lambda _: iter([link, stuck, old]))
    remove = os.rmdir
    monkeypatch.setattr(
        os, "rmdir", lambda path, **more: refuse() if "1" * DIGITS in str(path) else remove(path, **more)
    )
    assert obstacle(cache_folder.__wrapped__()) == ""
    assert link.is_symlink()
    assert list(target.rglob("*.o"))
    assert stuck.exists()
    assert not old.exists()


def test_a_folder_that_cannot_be_looked_through_is_left_alone(home, monkeypatch):
    monkeypatch.setattr(folder.Path, "iterdir", refuse)
    assert obstacle(cache_folder.__wrapped__()) == ""


def test_kernels_are_in_the_rooms_whose_sources_name_the_cache():
    makers = [
        source.relative_to(folder.TOP).as_posix()
        for package in ("modal", "towercrane")
        for source in (folder.TOP / package).rglob("*.py")
        if "import native" in source.read_text("utf-8") or "import loaded" in source.read_text("utf-8")
    ]
    assert len(makers) > 4
    assert all(maker.startswith(folder.ROOMS) for maker in makers)
    assert all((folder.TOP / room).is_dir() for room in folder.ROOMS)


def test_a_change_of_a_source_names_another_cache(tmp_path, monkeypatch):
    monkeypatch.delenv(folder.CHOSEN, raising=False)
    for name in ("modal/compiler", "towercrane/kernels"):
        (tmp_path / name).mkdir(parents=True)
    kernel, layout = tmp_path / "modal/roots.py", tmp_path / "towercrane/kernels/layout.py"
    monkeypatch.setattr(folder, "TOP", tmp_path)
    found = []
    for changed in (kernel, layout, kernel):
        changed.write_text(f"x = {len(found)}\n")
        folder.sources.cache_clear()
        found.append(folder.cache_folder.__wrapped__())
    folder.sources.cache_clear()
    assert len(set(found)) == 3


def refuse(*_, **__):
    raise PermissionError(13, "Permission denied")
