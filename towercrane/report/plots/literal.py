"""A figure whose text is text: no formula is read into the names that people give to cranes and cases."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure
from matplotlib.text import Text

from towercrane.schema.faults import printable_lines

if TYPE_CHECKING:
    from matplotlib.backend_bases import RendererBase

LONGEST, LONGEST_WRAPPED, MOST_LINES = 200, 600, 4
"""Letters and lines of one text beyond which it would fill the picture."""


class LiteralFigure(Figure):
    """Figure that draws dollars and backslashes as they are, and the beginning of what is too long."""

    def draw(self, renderer: RendererBase) -> None:
        """Draw everything."""
        powers = {
            label
            for axes in self.axes
            for axis in (axes.xaxis, axes.yaxis)
            if axis.get_scale() == "log"
            for label in (*axis.get_ticklabels(), *axis.get_ticklabels(minor=True))
        }
        found: Any = self.findobj(Text)
        # Only the powers of ten beside a logarithmic axis are formulas.
        written = {text: text.get_text() for text in found if text not in powers}
        for text, words in written.items():
            short = _shown(words, LONGEST_WRAPPED if text.get_wrap() else LONGEST)
            # What breaks lines reads formulas in any case.
            text.set_text(short.replace("$", r"\$") if text.get_wrap() else short)
            text.set_parse_math(text.get_wrap())
        with warnings.catch_warnings():
            # A letter that the font lacks is drawn as a box, a name that leaves no room over the axes.
            for harmless in ("Glyph .* missing from", "constrained_layout not applied"):
                warnings.filterwarnings("ignore", message=harmless, category=UserWarning)
            super().draw(renderer)
        for text, words in written.items():
            text.set_text(words)


def _shown(text: str, longest: int) -> str:
    """Text as it can be drawn."""
    lines = text.split("\n")
    short = printable_lines("\n".join(lines[:MOST_LINES])) + (" ..." if len(lines) > MOST_LINES else "")
    return short if len(short) <= longest else short[: longest - 3] + "..."
