"""Machine code on disk: what is damaged there is compiled anew, what cannot be kept there is said once."""

from __future__ import annotations

import io
import pickle
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

from numba.core import caching, config

from modal.compiler.files import say, sealed, verified
from modal.compiler.folder import obstacle

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

# Numba's own classes carry no types, and its settings too narrow ones.
_caching: Any = caching
_config: Any = config


def keep(dispatcher: Any, function: Callable[..., Any], folder: Path, content: str = "") -> None:
    """Let a dispatcher keep its machine code in a folder; it goes without, and says so, where that cannot be.

    Code that a function does not tell by itself, since it is written as it is compiled, is told by its content: a
    text that is equal for equal code.
    """
    if reason := obstacle(folder):
        say(f"kernels are compiled each time, for {folder} cannot keep them: {reason}")
        return
    before, _config.CACHE_DIR = _config.CACHE_DIR, str(folder)
    try:
        kept = KernelCache(function, content)
    finally:
        _config.CACHE_DIR = before
    # Where its own subfolder cannot be written numba would turn to the folder of the source.
    if kept.cache_path.startswith(str(folder)):
        dispatcher._cache = kept
    else:
        say(f"kernels are compiled each time, for {folder} cannot keep them: no right to write in its folders")


class KernelCache(_caching.FunctionCache):  # type: ignore[misc]
    """Cache of one kernel that takes a file which cannot be read for none."""

    def __init__(self, function: Callable[..., Any], content: str = "") -> None:
        super().__init__(function)
        self._content = content
        source_stamp = self._impl.locator.get_source_stamp()
        self._cache_file = KernelFile(self._cache_path, self._impl.filename_base, source_stamp)

    def _index_key(self, signature: Any, codegen: Any) -> Any:
        if self._content:
            return signature, codegen.magic_tuple(), self._content
        return super()._index_key(signature, codegen)

    def load_overload(self, signature: Any, context: Any) -> Any:
        """Machine code for a signature, None if there is none that can be used."""
        try:
            return super().load_overload(signature, context)
        # Bytes that are no pickle raise whatever they make of it.
        except Exception as error:
            say(f"damaged machine code in {self.cache_path} is compiled anew ({error})")
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, signature: Any, data: Any) -> None:
        """Keep machine code for a signature."""
        try:
            super().save_overload(signature, data)
        except OSError as error:
            say(f"machine code cannot be kept in {self.cache_path}: {(error.strerror or str(error)).lower()}")


class KernelFile(_caching.IndexDataCacheFile):  # type: ignore[misc]
    """Index and machine code of one kernel; each file begins with a digest of the rest."""

    def _load_index(self) -> dict[Any, str]:
        try:
            content = io.BytesIO(verified(self._index_path))
        except FileNotFoundError:
            return {}
        if pickle.load(content) != self._version:
            return {}
        stamp, overloads = pickle.load(content)
        return dict(overloads) if stamp == self._source_stamp else {}

    def _load_data(self, name: str) -> Any:
        return pickle.loads(verified(self._data_path(name)))

    @contextmanager
    def _open_for_write(self, path: str) -> Iterator[io.BytesIO]:
        content = io.BytesIO()
        yield content
        with super()._open_for_write(path) as file:
            file.write(sealed(content.getvalue()))
