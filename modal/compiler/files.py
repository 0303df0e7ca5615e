"""Files of machine code: sealed with a digest, and what is wrong with them said once."""

from __future__ import annotations

import hashlib
import os
import warnings

from modal.compiler.folder import CacheWarning

DIGEST = hashlib.sha256().digest_size
"""Bytes at the beginning of each file that tell whether the rest is what was written.

Machine code with a single wrong bit computes wrong numbers or ends the process, and no later check finds it.
"""


def sealed(content: bytes) -> bytes:
    """A content with its digest before it."""
    return hashlib.sha256(content).digest() + content


def verified(path: str) -> bytes:
    """What a file holds after its digest."""
    with open(path, "rb") as file:
        digest, content = file.read(DIGEST), file.read()
    if hashlib.sha256(content).digest() != digest:
        raise ValueError(f"{os.path.basename(path)} is not what was written")
    return content


def say(text: str) -> None:
    """Warn once in a process, whatever the kernel."""
    if not _said:
        _said.append(text)
        warnings.warn(text, CacheWarning, stacklevel=2)


_said: list[str] = []
