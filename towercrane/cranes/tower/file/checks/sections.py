"""Faults of the sections that a case names."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from towercrane.cranes.tower.file.checks.jib import jib_length
from towercrane.cranes.tower.file.checks.tower import tower_height
from towercrane.schema.faults import Fault, shown
from towercrane.schema.ranges import si

if TYPE_CHECKING:
    from collections.abc import Iterator

NAME = re.compile("[a-z][a-z0-9_]*")

MOST = 20
"""Sections of one case: each has up to eight outputs."""

KEYS = {"name", "of", "height", "position"}

PLACES = {"tower": ("height", tower_height), "jib": ("position", jib_length)}


def check_sections(tree: dict[str, Any]) -> Iterator[Fault]:
    """Names that are none, places off the tower or the jib, sections of a jib that bears its loads otherwise."""
    sections = tree.get("sections")
    if not isinstance(sections, list):
        return
    if len(sections) > MOST:
        yield Fault("", "sections", f"{MOST} tables [[sections]] at most", f"{len(sections)}")
    names: set[str] = set()
    for place, own in enumerate(sections):
        if not isinstance(own, dict):
            continue
        key, name, of = f"sections.{place}", own.get("name"), own.get("of")
        if isinstance(name, str):
            if not NAME.fullmatch(name):
                yield Fault("", f"{key}.name", 'small letters, digits and "_", such as "mast_3"', shown(name))
            if name in names:
                yield Fault("", f"{key}.name", "a name of its own", shown(name), "another section has this name")
            names.add(name)
        if of not in PLACES:
            continue
        wanted, length_of = PLACES[of]
        other = next(word for word, _ in PLACES.values() if word != wanted)
        # A key that is not known is misspelt, and told already.
        if wanted not in own and not own.keys() - KEYS:
            yield Fault("", f"{key}.{wanted}", f"a {wanted}, of a section of the {of}", "nothing: the key is missing")
        if other in own:
            yield Fault("", f"{key}.{other}", f"a {wanted}, of a section of the {of}", f"a {other}")
        length, asked = length_of(tree), si(own.get(wanted), "m")
        if length is not None and asked is not None and asked > length:
            yield Fault("", f"{key}.{wanted}", f"a {wanted} up to {length:g} m, the end of the {of}", f"{asked:g} m")
