"""Quantities with units at the door."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from towercrane.schema.faults import shown
from towercrane.schema.units import COMMON, QUANTITIES, UnitError, registry, split, to_si, wanted

LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "km": 1e3, "in": 0.0254, "ft": 0.3048, "µm": 1e-6, "metre": 1.0}

CORRECT = [
    ("18 m", "m", 18.0),
    ("-3 m", "m", -3.0),
    ("800kg", "kg", 800.0),
    ("1_000 m", "m", 1000.0),
    ("1.5e3 mm", "m", 1.5),
    (".5 m", "m", 0.5),
    ("23.8\u00a0m", "m", 23.8),
    ("206 GPa", "Pa", 206e9),
    ("206000 N/mm^2", "Pa", 206e9),
    ("8 cm^2", "m^2", 8e-4),
    ("8 cm²", "m^2", 8e-4),
    ("8 cm2", "m^2", 8e-4),
    ("8 cm**2", "m^2", 8e-4),
    ("1.4e6 cm^4", "m^4", 0.014),
    ("9.81 m/s2", "m/s^2", 9.81),
    ("48 m/min", "m/s", 0.8),
    ("3.6 km/h", "m/s", 1.0),
    ("2 min", "s", 120.0),
    ("180 deg", "rad", math.pi),
    ("5°", "rad", math.radians(5)),
    ("10 N m s/rad", "N m s/rad", 10.0),
    ("10 N*m*s/rad", "N m s/rad", 10.0),
    ("10 N m s", "N m s/rad", 10.0),
    ("60 kN m", "N m/rad", 60e3),
    ("1 N m/deg", "N m/rad", 180 / math.pi),
    ("30 rpm", "rad/s", math.pi),
    ("6 rev/min", "rad/s", math.pi / 5),
    ("60 N/mm", "N/m", 60e3),
    ("0.08 kg/m", "N s^2/m^2", 0.08),
    ("1 N m s/deg", "N m s/rad", 180 / math.pi),
    ("15.13 t", "kg", 15130.0),
    ("2 %", "1", 0.02),
    ("0.02", "1", 0.02),
    ("0.3 g", "m/s^2", 2.941995),
    ("300 g", "kg", 0.3),
    (18, "m", 18.0),
    (0.014, "m^4", 0.014),
]


@pytest.mark.parametrize(("text", "unit", "value"), CORRECT)
def test_reads(text, unit, value):
    assert to_si(text, unit) == pytest.approx(value, rel=1e-15)


@given(st.floats(-1e9, 1e9), st.sampled_from(sorted(LENGTHS)), st.sampled_from(["", " ", "  "]))
def test_any_length_round_trips(metres, unit, space):
    text = f"{metres / LENGTHS[unit]!r}{space}{unit}"
    assert to_si(text, "m") == pytest.approx(metres, rel=1e-14, abs=1e-300)


@pytest.mark.parametrize("unit", QUANTITIES)
def test_each_kind_reads_its_own_example_and_a_plain_number(unit):
    example = QUANTITIES[unit][1]
    assert to_si(example, unit) > 0.0
    assert to_si(2, unit) == 2.0
    assert to_si(f"2 {unit}", unit) == 2.0 if unit != "1" else to_si("2", unit) == 2.0
    assert QUANTITIES[unit][0] in wanted(unit)


def test_every_offered_unit_is_known():
    for unit in COMMON:
        assert registry().parse_units(unit)


WRONG = [
    ("23.8 s", "m", '"23.8 s", which is a time', ""),
    ("5 kN/m", "m", "which is a stiffness", ""),
    ("5 K", "m", "which is a quantity in K", ""),
    ("5 deg", "1", "which is an angle", ""),
    ("5 %", "rad", "which is a ratio", ""),
    ("2 rad/s", "m/s", "which is a rotary speed", ""),
    ("5 m^3", "m", "which is a quantity in", ""),
    ("206 Gpa", "Pa", 'whose unit "Gpa" is unknown', 'did you mean "GPa"?'),
    ("8 KG", "kg", 'whose unit "KG" is unknown', 'did you mean "kg"?'),
    ("5 degC", "m", 'whose unit "degC" is unknown', "did you mean"),
    ("3 dBm", "kg", 'whose unit "dBm" is unknown', "known units: mm, cm, m"),
    ("3 furlong", "m", 'whose unit "furlong" is unknown', "known units: mm, cm, m"),
    ("800", "kg", "which has no unit", 'write "800 kg"; without quotes a number is taken as kg'),
    ("0,8 m/s", "m/s", '"0,8 m/s"', "the decimal sign is a point"),
    ("", "m", '""', "begins with its number"),
    ("m", "m", '"m"', "begins with its number"),
    ("٣ m", "m", "٣", "begins with its number"),
    ("nan m", "m", "nan m", ""),
    ("-inf m", "m", "-inf m", ""),
    ("1e999 m", "m", "1e999 m", ""),
    ("1e308 km", "m", "1e308 km", ""),
    (math.nan, "m", "nan", ""),
    (10**400, "m", "0x", ""),
    (10**5000, "m", "0x", ""),
    (True, "m", "true", ""),
    ([18], "m", "a list of 1", ""),
    ({"vlaue": 18}, "m", "a table with vlaue", ""),
    (None, "m", "None", ""),
]


@pytest.mark.parametrize(("value", "unit", "got", "hint"), WRONG, ids=lambda v: shown(v)[:30])
def test_refuses_with_a_reason(value, unit, got, hint):
    with pytest.raises(UnitError) as caught:
        to_si(value, unit)
    assert QUANTITIES[unit][0] in caught.value.wanted
    assert got in caught.value.got
    assert hint in caught.value.hint
    assert caught.value.wanted in str(caught.value)


@pytest.mark.parametrize("value", ["nan m", "1e999 m", math.inf, 1e400])
def test_says_that_a_number_must_be_finite(value):
    with pytest.raises(UnitError, match="finite number"):
        to_si(value, "m")


MALFORMED = [
    "m +",
    "(m",
    "m)",
    "/",
    "m^-",
    "^2",
    "m/0",
    "m^1.5",
    "m 3",
    "m^x",
    "a.b",
    "import os",
    "m__x",
    "'",
    '"',
]
ENDLESS = ["m**9**9**9", "(m^9)^9^9", "m^99999999", "** 9**9**9 m", "m^9 ^9", "m" * 500]


@pytest.mark.parametrize("unit", [*MALFORMED, *ENDLESS, "m\n", "m;m", "lambda: 1", "__import__('os')", "\0"])
def test_malformed_units_are_refused_at_once(unit):
    if unit == "m\n":
        assert to_si("5 m\n", "m") == 5.0
        return
    with pytest.raises(UnitError):
        to_si(f"5 {unit}", "m")


@given(
    st.one_of(st.text(max_size=40), st.text("0123456789.eE+-_ m/^*()kgs°%", max_size=30)),
    st.sampled_from(sorted(QUANTITIES)),
)
def test_any_text_is_read_or_refused(text, unit):
    try:
        number = to_si(text, unit)
    except UnitError:
        number = 0.0
    assert math.isfinite(number)


def test_split_keeps_the_number_as_written():
    assert split("23.8 mm") == (23.8, "mm")
    assert split(210) == (210.0, "")
