"""Cases of the tests of the door, written with replacements into a folder of each test's own."""

from functools import partial

import pytest
from samples import case_files, jib_files, tower_files


@pytest.fixture
def write(tmp_path):
    """Write a case and its crane."""
    return partial(case_files.write_case, tmp_path)


@pytest.fixture
def write_tower(tmp_path):
    """Write a case and its crane with this tower."""
    return partial(tower_files.write_case, tmp_path)


@pytest.fixture
def write_jib(tmp_path):
    """Write a case and its crane with these jibs."""
    return partial(jib_files.write_case, tmp_path)
