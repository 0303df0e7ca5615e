"""Arguments that are no numbers of a crane: one ValueError that names argument, what was wanted and what came."""

from dataclasses import fields, replace
from math import inf, nan

import numpy as np
import pytest
from samples.qtz5613 import model, motions

from modal import Beam
from towercrane import Load, ModeCounts, TowerCrane, sweep
from towercrane.cases.case import case_folder, load_case
from towercrane.cranes.jib.parameters import JibCrane
from towercrane.cranes.parts.wind import WindAreas
from towercrane.cranes.slewing.build import parameters_of
from towercrane.cranes.slewing.description import Drive, Spring
from towercrane.cranes.tower.modes.damping import ModalDamping
from towercrane.motions.motion import phases, rest
from towercrane.motions.profiles import s_curve, smooth_ramps, speed_trapezoid, trapezoid
from towercrane.motions.shaping import boxes, ei, minimum_jerk, zv, zvd
from towercrane.simulation.simulate import simulate

CRANE = TowerCrane("A", Beam(30.0, 300.0, 2e11, 0.01), Beam(40.0, 100.0, 2e11, 0.003), 10.0, 150.0, 1e4, 300.0)
OBJECTS = {
    "TowerCrane": CRANE,
    "Load": Load(800.0),
    "WindAreas": WindAreas(),
    "ModalDamping": ModalDamping(),
    "JibCrane": JibCrane("B", 10.0, 1.0, 20.0, 50.0, 10.0, 40.0),
    "Drive": Drive("x", 1.0, 2.0, 0.1, 0.0),
    "Spring": Spring("x", {}, 1.0),
    "BasicParameters": parameters_of(load_case("slewing/basic/example-1").crane),
}
NUMBERS = [
    (name, field.name)
    for name, made in OBJECTS.items()
    for field in fields(made)
    if isinstance(getattr(made, field.name), float)
]
COUNTS = [(ModeCounts(), name) for name in ("tower", "torsion", "lateral", "vertical")]


@pytest.mark.parametrize(("name", "field"), NUMBERS, ids=".".join)
def test_every_number_of_a_crane_is_judged_as_it_is_made(name, field):
    for value in (-1.0, nan, inf, -inf, "3", None, True, 1j):
        with pytest.raises(ValueError, match=rf"{name}\.{field}: wanted .*, got "):
            replace(OBJECTS[name], **{field: value})
    for value in (np.float64(1.5), np.float32(1.5), 2):
        assert getattr(replace(OBJECTS[name], **{field: value}), field) == value


@pytest.mark.parametrize(
    ("made", "field"), COUNTS, ids=lambda item: item if isinstance(item, str) else type(item).__name__
)
def test_every_count_is_a_whole_number(made, field):
    for value in (-1, 2.0, "3", None, True, nan):
        with pytest.raises(ValueError, match=rf"{type(made).__name__}\.{field}: wanted .*zero or more, got "):
            replace(made, **{field: value})
    assert getattr(replace(made, **{field: np.int64(2)}), field) == 2


MOTIONS = {
    rest: (1.0, 2.0),
    trapezoid: (0.0, 10.0, 1.0, 0.5),
    s_curve: (0.0, 10.0, 1.0, 0.5, 0.5),
    speed_trapezoid: (0.0, 1.0, 2.0, 3.0),
    smooth_ramps: (0.0, 1.0, 2.0, 3.0),
    minimum_jerk: (0.0, 10.0, 5.0),
}
PLACES = [(make, place) for make, given in MOTIONS.items() for place in range(len(given))]


@pytest.mark.parametrize(("make", "place"), PLACES, ids=lambda item: getattr(item, "__name__", item))
def test_every_number_of_a_motion_is_judged(make, place):
    given = list(MOTIONS[make])
    make(*given)
    for value in (nan, inf, "3", None):
        given[place] = value
        with pytest.raises(ValueError, match=r"wanted .*, got "):
            make(*given)


@pytest.mark.parametrize("shaper", [zv, zvd, ei, boxes])
def test_frequencies_of_shapers_are_positive_numbers(shaper):
    for frequencies in ([], [0.0], [-1.0], [nan], ["3"], [0.1, None]):
        with pytest.raises(ValueError, match="frequencies: wanted"):
            shaper(frequencies)


@pytest.mark.parametrize(
    ("changed", "wanted"),
    [
        ({"motions": {**motions(), "rope": rest(-3.0)}}, "motions: wanted a rope longer than 0 m, got -3 m"),
        ({"motions": {**motions(), "rope": rest(0.0)}}, "motions: wanted a rope longer than 0 m, got 0 m"),
        ({"motions": {"trolley": rest(20.0)}}, "motions: wanted a Motion for 'rope', got None"),
        ({"motions": {**motions(), "rope": 18.0}}, "motions: wanted a Motion for 'rope', got 18.0"),
        ({"duration": nan}, "duration: wanted a positive finite number, got nan"),
        ({"duration": "10"}, "duration: wanted a positive finite number, got '10'"),
        ({"output_step": -1.0}, "output_step: wanted a positive finite number, got -1.0"),
    ],
)
def test_arguments_of_a_simulation_are_judged_before_it(changed, wanted):
    with pytest.raises(ValueError, match=wanted):
        simulate(model(1, 1), **{"motions": motions(), "duration": 1.0, **changed})


def test_duration_of_phases_is_positive():
    with pytest.raises(ValueError, match="duration: wanted a positive finite number, got -1"):
        phases((rest(1.0),), -1.0)


def test_sweep_takes_a_path():
    path = case_folder() / "qtz5613" / "condition-3.toml"
    runs = sweep(path, {"run.duration": [0.1], "solver.rtol": [1e-4]})
    assert runs["outcome"].values.tolist() == ["finished"]
