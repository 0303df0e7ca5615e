"""Turbulence: spectra, coherence and profile of the synthesis, and how many places on a crane are enough."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from samples import space_crane as space
from scipy.integrate import quad

from towercrane.cranes.parts.turbulence.field import Places, field_motions, turbulence_of
from towercrane.cranes.parts.turbulence.profile import Profile
from towercrane.cranes.parts.turbulence.spectra import SPECTRA, class_deviation, eurocode_intensity, turbulence_scale
from towercrane.cranes.parts.turbulence.synthesis import Turbulence
from towercrane.cranes.parts.turbulence.tables import Wind
from towercrane.cranes.parts.wind import CHANNELS, WindAreas, WindNodes, steady
from towercrane.cranes.tower.modes.modal_crane import flexible_crane
from towercrane.cranes.tower.modes.mode_counts import ModeCounts

SPEED, HUB, COUNTER = 12.0, 24.0, 12.3
AREAS = WindAreas(tower=0.8, jib=0.5, counter_jib=0.6, counterweight=4.0)
PLACES = np.array([[0.0, 0.0, HUB], [15.0, 0.0, HUB], [30.0, 0.0, 6.0]])
SPEEDS = np.full(3, SPEED)


def turbulence(name="kaimal", **options):
    described = {"step": 0.25, "duration": 256.0, "seed": 3} | options
    return Turbulence(SPECTRA[name], 1.5, 1.5 * SPECTRA[name].deviation_across, **described)


@pytest.mark.parametrize("name", SPECTRA)
@pytest.mark.parametrize("component", ["along", "across"])
def test_a_spectrum_integrates_to_its_variance(name, component):
    own = SPECTRA[name]
    scale = own.scale(np.array([HUB]), 0.05)

    def over_logarithm(x):
        f = np.exp([x])
        return float(own.density(f, component, 1.5, scale, np.array([SPEED]))[0, 0] * f[0])

    assert quad(over_logarithm, -25.0, 40.0, limit=400)[0] == pytest.approx(2.25, rel=2e-4)


def test_spectra_are_those_of_their_standards():
    f, speed = np.array([0.1]), np.array([SPEED])

    def at(name, component):
        own = SPECTRA[name]
        return own.density(f, component, 1.5, own.scale(np.array([HUB]), 0.05), speed)[0, 0]

    # IEC 61400-1: Lambda = 0.7 z, 8.1 and 2.7 Lambda; EN 1991-1-4: L = 300 (z/200)^(0.67 + 0.05 ln z0).
    n = 0.1 * 8.1 * 16.8 / SPEED
    assert at("kaimal", "along") == pytest.approx(2.25 * 4.0 * n / 0.1 / (1.0 + 6.0 * n) ** (5 / 3), rel=1e-13)
    n /= 3.0
    assert at("kaimal", "across") == pytest.approx(2.25 * 4.0 * n / 0.1 / (1.0 + 6.0 * n) ** (5 / 3), rel=1e-13)
    n = 0.1 * 300.0 * 0.12 ** (0.67 + 0.05 * np.log(0.05)) / SPEED
    assert at("en-1991-1-4", "along") == pytest.approx(2.25 * 6.8 * n / 0.1 / (1.0 + 10.2 * n) ** (5 / 3), rel=1e-13)
    n = 0.1 * 3.5 * 16.8 / SPEED
    assert at("von-karman", "along") == pytest.approx(2.25 * 4.0 * n / 0.1 / (1 + 70.8 * n * n) ** (5 / 6), rel=1e-13)
    assert (turbulence_scale(24.0), turbulence_scale(80.0)) == (pytest.approx(16.8), 42.0)
    assert class_deviation(0.14, SPEED) == pytest.approx(0.14 * (9.0 + 5.6))
    assert eurocode_intensity(HUB, 0.05) == pytest.approx(1.0 / np.log(480.0))


@pytest.mark.parametrize("component", [0, 1])
def test_the_first_place_has_its_spectrum_line_by_line(component):
    own = turbulence()
    (found, *_) = own.series(PLACES, SPEEDS, SPEED, HUB)[component]
    lines = np.arange(1, own.count // 2) / own.duration
    power = 2.0 * own.duration * abs(np.fft.rfft(found)[1:-1] / own.count) ** 2
    wanted = own.densities(lines, own.components[component], PLACES[:1, 2], SPEEDS[:1])[:, 0]
    assert_allclose(power, wanted, rtol=1e-9)


def test_spectra_and_coherence_over_many_seeds_are_those_asked_for():
    runs = 120
    spectra, shared = np.zeros((2, 3, 3, turbulence().count // 2 - 1), dtype=complex), 0.0
    for seed in range(runs):
        own = turbulence(seed=seed)
        waves = np.fft.rfft(own.series(PLACES, SPEEDS, SPEED, HUB))[..., 1:-1] / own.count
        shared = shared + waves[0, 0] * waves[1, 0].conj() / abs(waves[0, 0] * waves[1, 0])
        spectra += np.einsum("cik,cjk->cijk", waves, waves.conj()) * 2.0 * own.duration / runs
    lines, distances = np.arange(1, own.count // 2) / own.duration, np.linalg.norm(PLACES[:, None] - PLACES, axis=-1)
    coherence = own.coherence(lines, distances, SPEED, HUB)
    length = 8.1 * 0.7 * HUB
    assert coherence[40, 0, 1] == pytest.approx(
        np.exp(-12.0 * 15.0 * np.hypot(lines[40] / SPEED, 0.12 / length)), rel=1e-13
    )
    # Means over bands of eight lines and the seeds: errors of about 1 / sqrt(8 * 120).
    bands = [slice(a, a + 8) for a in (0, 8, 24, 60, 120)]
    for component, (own_spectra, name) in enumerate(zip(spectra, own.components, strict=True)):
        size = np.sqrt(own.densities(lines, name, PLACES[:, 2], SPEEDS)).T
        found = own_spectra / (size[:, None] * size)
        for band in bands:
            assert_allclose(found[..., band].mean(axis=-1), coherence[band].mean(axis=0), atol=0.12)
        assert abs(found.mean(axis=-1) - coherence.mean(axis=0)).max() < 0.02, component
    # Along and across share nothing.
    assert abs(shared.mean() / runs) < 0.02


def test_what_a_record_of_ten_minutes_lacks_is_small_and_known():
    own = turbulence(duration=600.0, step=0.1)

    def density(f):
        return float(own.densities(np.array([f]), "along", np.array([HUB]), np.array([SPEED]))[0, 0])

    below, seen = quad(density, 0.0, 1.0 / 1200.0)[0], quad(density, 0.0, 2.0, limit=200)[0]
    assert below / 2.25 == pytest.approx(0.036, abs=5e-4)
    assert 1.0 - seen / 2.25 == pytest.approx(0.038, abs=5e-4)
    # All lines of the record together: the integral less what is below the first and beyond the last.
    variance = own.series(PLACES[:1], SPEEDS[:1], SPEED, HUB)[0].var()
    beyond = 1.0 - quad(density, 0.0, 5.0, limit=200)[0] / 2.25
    assert variance / 2.25 == pytest.approx(1.0 - 0.0361 - beyond, abs=5e-3)


def test_a_seed_gives_the_same_wind_again_and_another_another():
    first, again, other = (turbulence(seed=seed).series(PLACES, SPEEDS, SPEED, HUB) for seed in (7, 7, 8))
    assert np.array_equal(first, again)
    assert abs(first - other).std() > 1.0


def test_profiles_are_those_of_their_standards():
    assert_allclose(Profile("power", 10.0, 0.2).share([10.0, 23.8]), [1.0, 2.38**0.2], rtol=1e-14)
    wanted = np.log(np.array([10.0, 23.8, 2.0, 2.0]) / 0.05) / np.log(200.0)
    assert_allclose(Profile("log", 10.0, roughness_length=0.05).share([10.0, 23.8, 2.0, 0.3]), wanted, rtol=1e-14)
    with pytest.raises(ValueError, match=r"Profile\.roughness_length: wanted less"):
        Profile("log", roughness_length=2.0)


TURBULENT = {"spectrum": "kaimal", "seed": 5, "reference_class": "B", "ramp": "20 s"}
FIELD = Wind.model_validate(
    {"speed": "12 m/s", "direction": "30 deg", "profile": "power", "turbulence": TURBULENT}
)  # fmt: skip


def test_a_turbulent_wind_begins_at_its_mean_and_keeps_it():
    where = Places(PLACES, HUB, 7.0)
    shares = Profile("power").share(PLACES[:, 2])
    moved = field_motions(FIELD, steady([SPEED * np.cos(np.pi / 6), SPEED * np.sin(np.pi / 6), 0.0]), where, 100.0)
    for node, share in enumerate(shares):
        ending = "" if node == 2 else f"_{node + 1}"
        for axis, way in (("x", np.cos(np.pi / 6)), ("y", np.sin(np.pi / 6))):
            own = moved[f"wind_{axis}{ending}"]
            assert own(0.0) == pytest.approx(SPEED * share * way, abs=1e-12)
            assert own.mean == pytest.approx(SPEED * share * way, abs=1e-12)
            assert abs(own(0.2) - own(0.0)) < 2e-3 < 0.3 < np.std(own(np.arange(20.0, 600.0, 0.1)))
    # Runs of up to ten minutes are beginnings of one record.
    longer = field_motions(FIELD, steady([0.0, 0.0, 0.0]), where, 600.0)
    assert np.array_equal(longer["wind_x"].coefficients, moved["wind_x"].coefficients)
    assert turbulence_of(FIELD, where, 100.0).deviation == pytest.approx(0.14 * (0.75 * 12.0 * 2.4**0.2 + 5.6))
    assert moved["wind_z"].end == 0.0
    along = Wind.model_validate(FIELD.model_dump() | {"turbulence": TURBULENT | {"across": False}})
    moved = field_motions(along, steady([0.0, 0.0, 0.0]), where, 100.0)
    across = moved["wind_y"](np.arange(0.0, 100.0)) - np.tan(np.pi / 6) * moved["wind_x"](np.arange(0.0, 100.0))
    assert abs(across).max() < 1e-13 * SPEED


@pytest.fixture(scope="module")
def exposed():
    """Slewing moment per pressure at each place on what turns: places and moments by their number on the jib."""

    def of(nodes):
        found = flexible_crane(space.CRANE, ModeCounts(0, 0, 0, 0), AREAS, nodes=nodes).exposure.head
        places = nodes.along_jib(space.CRANE.jib.length, COUNTER) if nodes else np.zeros(1)
        return places, np.array([part.jib.moment + part.counter.moment for part in found])

    return {jib: of(WindNodes(jib=jib)) for jib in (3, 5, 30)} | {1: of(None)}


def test_nodes_share_out_what_one_wind_presses_on(exposed):
    # int c x dx of jib, counter-jib and counterweight.
    total = 0.6125 * (0.5 * 55.6**2 / 2.0 - 0.6 * COUNTER**2 / 2.0 - 4.0 * COUNTER)
    for _, moments in exposed.values():
        assert moments.sum() == pytest.approx(total, rel=1e-12)
    nodes = WindNodes(tower=2, profile=Profile("power"))
    parts = flexible_crane(space.CRANE, ModeCounts(2, 0, 0, 0), AREAS, nodes=nodes).exposure.tower
    modes = space.CRANE.tower_modes(2)
    for part, (low, high) in zip(parts, ((0.0, 11.9), (11.9, 23.8)), strict=True):
        shape = Profile("power").share(0.5 * (low + high))

        def press(z, power, at=shape):
            return 0.49 * (Profile("power").share(z) / at) ** 2 * z**power

        for power, found in enumerate((part.area, part.moment)):
            wanted = quad(press, low, high, args=(power,), points=[2.0] if low < 2.0 else None)[0]
            assert found == pytest.approx(float(wanted), rel=2e-3)
        swept = quad(lambda z, press=press: press(z, 0) * modes(z)[1], low, high)[0]
        assert part.swept[1] == pytest.approx(swept, rel=2e-3)


@pytest.mark.parametrize(("jib", "whole", "band"), [(1, 1.22, 1.55), (3, 1.056, 1.20), (5, 1.03, 1.09)])
def test_five_places_on_the_jib_give_the_slewing_moment_of_a_continuum(exposed, jib, whole, band):
    own = turbulence(duration=600.0)
    lines = np.geomspace(1.0 / 1200.0, 5.0, 300)
    density = own.densities(lines, "along", np.array([HUB]), np.array([SPEED]))[:, 0]

    def deviation(nodes, inside):
        places, moments = exposed[nodes]
        coherence = own.coherence(lines, abs(places[:, None] - places), SPEED, HUB)
        power = density * np.einsum("i,kij,j->k", moments, coherence, moments)
        return np.sqrt(np.trapezoid((power * lines)[inside], np.log(lines[inside])))

    for inside, ratio in ((lines > 0.0, whole), ((lines > 0.05) & (lines < 0.5), band)):
        assert deviation(jib, inside) / deviation(30, inside) == pytest.approx(ratio, abs=0.01)


def test_one_wind_keeps_its_three_channels():
    assert space.model(1, 1, 1, 1, areas=AREAS, wind=1).value_channels == CHANNELS
    many = space.model(1, 1, 1, 1, areas=AREAS, nodes=WindNodes(), wind=WindNodes().count)
    assert len(many.value_channels) == 2 * 9 + 1
    assert many.value_channels[-3:] == CHANNELS
