"""The rooms of the two packages: which may import which, no circle of modules, folders that one can look over."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import modal
import towercrane
from towercrane.cranes.registry import KINDS

PACKAGES = [Path(package.__file__).parent for package in (modal, towercrane)]
FOLDERS = [
    folder
    for package in PACKAGES
    for folder in (package, *package.rglob("*/"))
    # Caches, and the shipped cases in an installed package.
    if not any(part[0] in "_." for part in folder.relative_to(package).parts)
]

BELOW = {
    "modal": (),
    "schema": ("modal",),
    "motions": ("modal",),
    "results": ("modal",),
    "kernels": ("modal",),
    "simulation": ("kernels", "motions", "results"),
    "linear": ("simulation",),
    "cranes": ("schema", "simulation"),
    "cases": ("cranes",),
    "accuracy": ("cases",),
    "runs": ("accuracy", "linear"),
    "studies": ("runs",),
    "report": ("studies",),
    "bench": ("studies",),
    "commands": ("report", "bench"),
    "cli": ("commands",),
    "__main__": ("cli",),
    "towercrane": ("cli",),
}
"""What a room may import, and all below it; the last two are doors for users, which no room goes through."""


@cache
def imports():
    """Modules that each module imports: anywhere in it, for types alone, or by their names in a text."""
    paths = [(path.relative_to(package.parent), path) for package in PACKAGES for path in package.rglob("*.py")]
    files = {".".join(inside.with_suffix("").parts).removesuffix(".__init__"): path for inside, path in paths}
    found = {}
    for name, path in files.items():
        named = set()
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ImportFrom):
                named |= {node.module, *(f"{node.module}.{part.name}" for part in node.names)}
            elif isinstance(node, ast.Import):
                named |= {part.name for part in node.names}
            elif isinstance(node, ast.Constant) and "." in str(node.value):
                named.add(node.value)
        named &= files.keys()
        # Who names a module in a package has no arrow to the package itself.
        found[name] = {one for one in named if not any(other.startswith(one + ".") for other in named)}
    return found


def room(module):
    first, *rest = module.split(".")
    return first if first == "modal" or not rest else rest[0]


def reach(name):
    return {name}.union(*map(reach, BELOW[name]))


def test_rooms_import_those_below_them():
    arrows = {(room(one), room(other)) for one, others in imports().items() for other in others}
    assert not {f"{one} {other}" for one, other in arrows if other not in reach(one)}


def compared(tree):
    """What stands in each comparison: the sides of a condition, or the subject of a match and its patterns."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Compare):
            yield [node.left, *node.comparators]
        elif isinstance(node, ast.Match):
            yield [node.subject, *(part for case in node.cases for part in ast.walk(case.pattern))]


def names_compared(tree):
    """Names of kinds of crane in comparisons; a jib and a tower are members too, unless a kind is compared."""
    for sides in compared(tree):
        words = {str(getattr(one, "value", "")) for side in sides for one in (side, *getattr(side, "elts", ()))}
        of_kind = any("kind" in getattr(side, "attr", getattr(side, "id", "")) for side in sides)
        yield from words & (KINDS.keys() if of_kind else KINDS.keys() - {"jib", "tower"})


def test_nobody_but_the_cranes_compares_a_kind_by_its_name():
    for path in set(PACKAGES[1].rglob("*.py")) - set((PACKAGES[1] / "cranes").rglob("*.py")):
        assert not list(names_compared(ast.parse(path.read_text("utf-8")))), path


@pytest.mark.parametrize(("code", "found"), [
    ('case.kind == "tower"', ["tower"]),
    ('kind not in ("jib", "bridge")', ["jib"]),
    ('match crane.kind:\n    case "tower" | "post":\n        pass', ["tower"]),
    ('name == "overhead"', ["overhead"]),
    ('member == "tower"', []),
])  # fmt: skip
def test_a_comparison_with_the_name_of_a_kind_is_seen(code, found):
    assert list(names_compared(ast.parse(code))) == found


def test_no_module_imports_itself_by_way_of_others():
    graph = {one: others - {one} for one, others in imports().items()}
    TopologicalSorter(graph).prepare()


def test_every_folder_says_what_it_is_for():
    for folder in FOLDERS:
        sentence = ast.get_docstring(ast.parse((folder / "__init__.py").read_text("utf-8")))
        assert sentence, folder
        assert sentence.endswith("."), folder


def test_folders_can_be_looked_over():
    assert not [folder for folder in FOLDERS if len(list(folder.glob("*.py"))) > 15]
