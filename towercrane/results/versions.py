"""Versions of this package and of what its numbers rest on."""

from __future__ import annotations

import platform

__version__ = "0.1.0"


def versions() -> dict[str, str]:
    """Version of this package, of Python and of the libraries that compute, by name."""
    import llvmlite
    import numpy as np
    import scipy

    return {
        "towercrane": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "llvmlite": llvmlite.__version__,
        "scipy": scipy.__version__,
    }
