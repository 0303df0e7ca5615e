"""The console of reports: text is text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rich.console import Console

from towercrane.schema.faults import printable_lines

if TYPE_CHECKING:
    from rich.text import Text


class ReportConsole(Console):
    """Console on which text is text: brackets and colons mark nothing, what a terminal would obey is spelled out."""

    def render_str(self, text: str, **options: Any) -> Text:
        """Text as it is printed."""
        spelled = text if text.isprintable() else printable_lines(text)
        return super().render_str(spelled, **{**options, "markup": False, "emoji": False, "highlight": False})
