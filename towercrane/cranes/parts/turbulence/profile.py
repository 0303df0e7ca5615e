"""Mean wind over height."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from modal.checks import check_fields

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

LAWS = "uniform", "power", "log"


@dataclass(frozen=True, slots=True)
class Profile:
    """Mean wind over height, in shares of that at a reference height.

    Parameters
    ----------
    law : {"uniform", "power", "log"}
        The same everywhere; (z / z_r)^exponent, IEC 61400-1:2019, Eq. 10; ln(z / z_0) / ln(z_r / z_0),
        EN 1991-1-4:2005, 4.3.2.
    reference_height : float
        At which the wind's speed is given [m].
    exponent : float
    roughness_length : float
        z_0 of the ground [m].
    minimum_height : float
        Below it the wind is as there [m].

    Raises
    ------
    ValueError
        If the law is another, a number is not positive, or the heights of a logarithm are not above the roughness.
    """

    law: Literal["uniform", "power", "log"] = "uniform"
    reference_height: float = 10.0
    exponent: float = 0.2
    roughness_length: float = 0.05
    minimum_height: float = 2.0

    def __post_init__(self) -> None:
        check_fields(self, positive=self.__slots__[1:])
        if self.law not in LAWS:
            raise ValueError(f"Profile.law: wanted one of {', '.join(LAWS)}, got {self.law!r}")
        if self.law == "log" and not self.roughness_length < min(self.reference_height, self.minimum_height):
            wanted = "less than reference and minimum height"
            raise ValueError(f"Profile.roughness_length: wanted {wanted}, got {self.roughness_length!r}")

    def share(self, heights: ArrayLike) -> Floats:
        """Wind at heights over the ground [m] over that at the reference height; shape as ``heights``."""
        z = np.maximum(np.asarray(heights, dtype=float), self.minimum_height)
        if self.law == "power":
            return np.asarray((z / self.reference_height) ** self.exponent)
        if self.law == "log":
            return np.asarray(
                np.log(z / self.roughness_length) / np.log(self.reference_height / self.roughness_length)
            )
        return np.ones_like(z)
