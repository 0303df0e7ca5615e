"""Figures in the READMEs that are cheap to compute are those of the program; files that they name are there."""

import re
from pathlib import Path

import numpy as np
import pytest

from modal import Beam, EndBody, cantilever_modes
from towercrane import load_case
from towercrane.cases.models import motions_of
from towercrane.cranes.slewing.build import builder_of, parameters_of
from towercrane.results.measures import gap
from towercrane.runs.run import record_case
from towercrane.runs.summary import summarise
from towercrane.studies.lattice import lattice_report
from towercrane.studies.sensitivity import STUDIED_OUTPUTS, study

TOP = Path(__file__).parents[1]
PAGES = (
    TOP / "README.md",
    *sorted(path for room in ("cases", "modal", "towercrane") for path in (TOP / room).rglob("README.md")),
)
README = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
NUMBER = re.compile(r"(?<![\w.^])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def test_newcomers_find_two_commands_and_short_pages():
    first = PAGES[0].read_text(encoding="utf-8")
    assert sum(line.startswith("python3 -m venv") for line in first.splitlines()) == 2
    assert len(first) < 15_000


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(TOP).as_posix())
def test_pages_name_files_that_are_there(page):
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#:]+)\)", text)
    assert all((page.parent / link).exists() for link in links), links
    named = re.findall(r"`((?:modal|towercrane|tests)/[\w/]*[\w.]*)`", text)
    assert [name for name in named if not (TOP / name).exists()] == []
    # In a list of files those after the first stand in its folder.
    for folder, rest in re.findall(r"`((?:modal|towercrane)/[\w/]*/)\w+\.py`((?:, `\w+\.py`)+)", text):
        missing = [name for name in re.findall(r"\w+\.py", rest) if not (TOP / folder / name).exists()]
        assert missing == [], folder


def test_every_page_is_linked_from_the_first():
    first = PAGES[0].read_text(encoding="utf-8")
    assert [page for page in PAGES[1:] if f"({page.relative_to(TOP).as_posix()})" not in first] == []


def cells(start, number=0):
    """Cells of the table row that begins with these words, of several rows the one of that number."""
    rows = [line for line in README.splitlines() if line.startswith(f"| {start}")]
    return [cell.strip() for cell in rows[number].strip("|").split(" | ")]


def numbers(text):
    return [float(found) for found in NUMBER.findall(text)]


def says(text, *computed):
    """Every number as it is printed: the computed one, rounded to the printed digits."""
    for printed, value in zip(NUMBER.findall(text), computed, strict=True):
        digits = len(printed.partition(".")[2])
        assert float(printed) == pytest.approx(value, abs=0.5000001 * 10.0**-digits), (text, printed, value)


def run(name, *changes):
    case = load_case(name, list(changes))
    result = record_case(case)
    return result, summarise(case, result)


@pytest.fixture(scope="module")
def conditions():
    return {number: run(f"qtz5613/condition-{number}") for number in (1, 2, 3, 4)}


def largest(result, name):
    return float(abs(result[name].values).max())


def test_roots_of_the_tower():
    tower = Beam(length=23.8, mass_per_length=350.0, youngs_modulus=206e9, second_moment_of_area=0.014)
    roots = cantilever_modes(tower, 4, EndBody(mass=23973.0, rotary_inertia=9.481e6)).roots
    says(re.search(r"print\(modes.roots, .*?# roots (.*)", README)[1], *roots)
    says(cells("roots 0.765")[1], roots[0], roots[1], roots[3])
    says(cells("root 4.780")[1], roots[2])


def test_what_the_corrected_equations_make_of_the_printed_claims(conditions):
    says(cells("swing period 8.52 s")[1], conditions[3][1]["swing_period_s"])
    rigid = [run(f"qtz5613/condition-{n}", "model.tower_modes=0", "model.jib_vertical_modes=0")[0] for n in (3, 4)]
    swings = [largest(result, "sway_radial") for result in (conditions[3][0], conditions[4][0], *rigid)]
    says(cells("largest swing 0.020")[1], *swings)
    travel = {n: float(np.ptp(conditions[n][0]["tower_tip_displacement"].values)) for n in (1, 2)}
    speeds = {n: largest(conditions[n][0], "trolley_speed") for n in (1, 2)}
    says(cells("tower displacement grows")[1], 1e3 * travel[1], speeds[1], 1e3 * travel[2], speeds[2])
    peaks = conditions[3][1]["spectrum_peaks_hz"]
    assert numbers(cells("tower spectrum peaks")[1])[:2] == [round(f, 2) for f in peaks[-2:]]


def test_swings_of_the_undeformed_start():
    result, _ = run("qtz5613/condition-4-zero")
    found = re.search(r"pumps the swing to (\S+) rad.*?slack after (\d+) s", README, re.DOTALL)
    pushes = result.times[result["hoist_rope_force"].values < 0.0][0]
    says(f"{found[1]} {found[2]}", largest(result, "sway_radial"), pushes)


def test_slower_ramps_of_the_laboratory_crane():
    sways = [np.degrees(run(f"slewing/multi-mass/example-{n}")[0]["sway_radial"].values.max()) for n in range(1, 7)]
    says(cells("slower ramps swing less")[1], *sways)
    says(cells("radial sway up to 26")[1].partition(" at ")[0], sways[0])
    result, _ = run("slewing/multi-mass/example-1")
    at = result.times
    radial, tangential = (np.degrees(result[f"sway_{way}"].values) for way in ("radial", "tangential"))
    says(cells("radial sway up to 26")[1], sways[0], at[radial.argmax()])
    inwards = np.where(at < 3.0, radial, 0.0)
    says(cells("first an apparent shift")[1], inwards.min(), at[inwards.argmin()])
    says(cells("largest lag right after")[1], tangential.min(), at[tangential.argmin()])
    stop = 9.42
    after = tangential[at >= stop].max()
    says(cells("largest tangential sway after")[1], tangential.max(), at[tangential.argmax()], after)
    basic, _ = run("slewing/basic/example-1")
    early = basic.times < 3.0
    says(cells("basic model shows no shift")[1], np.degrees(basic["sway_radial"].values[early]).min())


def test_the_plan_of_the_jib_crane():
    result, summary = run("jib-crane/plan")
    says(cells("sway frequency about 0.1")[1], summary["natural_frequencies_hz"][0])
    free = result.times >= 80.0
    sway = float(abs(result["sway_in_plane"].values[free]).max())
    says(cells("sway persists after")[1], 1e3 * sway, 1e3 * 20.0 * sway)
    says(cells("sway may exceed")[1], np.degrees(largest(result, "sway_in_plane")))


def test_what_hardly_matters_to_the_laboratory_crane():
    case = load_case("slewing/basic/example-1")
    vary = ["drive_damping", "damping_jib_lateral", "damping_jib_vertical", "damping_jib_radial", "drag_jib_tip"]
    found = study(
        parameters_of(case.crane), builder_of(case.checked), motions_of(case), case.run.duration,
        vary=vary, percent=[50.0, 100.0, 150.0],
    )  # fmt: skip
    most = {entry["parameter"]: max(entry["near"].values()) for entry in found.influence}
    rigid = {entry["member"]: max(filter(None, entry["change"].values())) for entry in found.members}
    says(cells("tower extension, jib")[1], 100.0 * rigid["rope"], 100.0 * rigid["jib_radial"])
    plain = record_case(case)
    moved = [record_case(load_case(case.path, [f"payload.drag={drag} kg/m"])) for drag in (0.04, 0.12)]
    drag = {n: max(gap(plain, other, n) for other in moved) / largest(plain, n) for n in STUDIED_OUTPUTS}
    damping = max(most[name] for name in vary[1:4])
    figures = (damping, most["drag_jib_tip"], max(drag.values()), drag["sway_radial"], most["drive_damping"])
    text = cells("damping and air drag")[1].partition("any output: ")[2]
    says(text, *(100.0 * figure for figure in figures))


def test_slowest_motions_of_the_crane_in_space():
    """At the end of the manoeuvre: trolley at 40 m, 12 m of rope."""
    case = load_case("qtz5613/manoeuvre")
    natural = summarise(case, record_case(case))["natural_frequencies_hz"]
    found = re.search(r"the pendulum's (\S+) Hz down to (\S+) Hz", README)
    says(f"{found[1]} {found[2]}", np.sqrt(9.81 / 12.0) / (2.0 * np.pi), natural[0])


def test_the_lattice_beside_its_beams():
    models = {model["name"]: model for model in lattice_report(load_case("qtz5613/condition-3"))["models"]}
    truss = models["truss"]["answers"]
    says(
        " ".join(cells("truss, 3-D")[1:5]).replace("3-D", ""),
        1e6 * truss["force_deflection"], 1e6 * truss["moment_deflection"],
        *truss["frequencies_hz"], *truss["body_frequencies_hz"],
    )  # fmt: skip
    for row, name in (
        ("shear-flexible beam", "shear-flexible"),
        ("Euler beam", "euler"),
        ("code-equivalent", "code-equivalent"),
    ):
        model = next(model for key, model in models.items() if key.lower().startswith(name.split("-")[0]))
        errors = model["errors"]
        every = [
            errors["force_deflection"],
            errors["moment_deflection"],
            *errors["frequencies_hz"],
            *errors["body_frequencies_hz"],
        ]
        says(" ".join(cells(row)[1:5]), *(100.0 * error for error in every))
