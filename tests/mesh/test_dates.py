"""Dates and lengths of the times of files."""

import itertools
import sys
from datetime import timedelta

import numpy as np
import pytest

from vizlight.mesh import dates


@pytest.mark.parametrize(
    ("time", "unit", "expected"),
    [
        (0, "hours since 1900-01-01", "1900-01-01 00:00"),
        (1054152, "hours since 1900-1-1 00:00:0.0", "2020-04-04 00:00"),
        (1.5e9, "seconds since 1970-1-1T0:00:00Z", "2017-07-14 02:40"),
        (0.5, "days since 2000-02-28 18:30", "2000-02-29 06:30"),
        (6, "Hours since 2000-01-01 00:00:00 -6:30", "2000-01-01 12:30"),
        (0, "days since 2000-01-01 06:00 +0100", "2000-01-01 05:00"),
        (1 / 3, "days since 2001-01-01, proleptic_gregorian calendar", "2001-01-01 08:00"),
        (17067072, "hours since 1-1-1 00:00:0.0", "1948-01-01 00:00"),
        (3, "weeks since 2000-01-01", "2000-01-22 00:00"),
        (6e4, "ms since 2000-01-01", "2000-01-01 00:01"),
        (0, "months since 1900-01-01", "1900-01-01 00:00"),
        (1200, "months since 1900-01-01", "2000-01-01 00:00"),
        (1.5, "months since 2000-01-01, noleap calendar", "2000-02-15 12:00"),
        (-2, "months since 2000-01-15", "1999-11-15 00:00"),
        (100.25, "years since 1900-1-1", "2000-04-01 00:00"),
        (20010215.5, "day as %Y%m%d.%f", "2001-02-15 12:00"),
    ],
)  # fmt: skip
def test_a_time_is_a_date_where_its_unit_names_a_day(time, unit, expected, monkeypatch):
    monkeypatch.setitem(sys.modules, "cftime", None)
    assert dates.date(time, unit) == expected


@pytest.mark.parametrize(
    ("time", "unit", "expected"),
    [
        (60, "days since 2000-01-01, noleap calendar", "2000-03-02 00:00"),
        (59, "days since 2001-01-01, 360_day calendar", "2001-02-30 00:00"),
        (13, "months since 2001-01-01, 360_day calendar", "2002-02-01 00:00"),
        (1 / 3, "days since 0001-01-01", "0001-01-01 08:00"),
    ],
)
def test_calendars_of_models_and_of_julius(time, unit, expected, monkeypatch):
    pytest.importorskip("cftime")
    assert dates.date(time, unit) == expected
    monkeypatch.setitem(sys.modules, "cftime", None)
    assert dates.date(time, unit) == ""


@pytest.mark.parametrize(
    ("time", "unit"),
    [
        (3, "days since 2000-01-01, lunar calendar"), (1e300, "days since 2000-01-01"),
        (1e12, "days since 2000-01-01"),
        (np.nan, "months since 2000-01-01"), (3, "days since 2000-13-01"), (3, "days"),
        (3, "fortnights since 2000-01-01"), (3, ""),
    ],
)  # fmt: skip
def test_other_times_are_no_dates(time, unit):
    assert dates.date(time, unit) == ""


def test_dates_are_those_of_cftime(random):
    cftime = pytest.importorskip("cftime")
    for _ in range(60):
        year, month, day = random.integers((1, 1, 1), (2100, 13, 29))
        unit = f"days since {year}-{month}-{day} {random.integers(24)}:{random.integers(60)}"
        time = cftime.date2num(
            cftime.datetime(*random.integers((1583, 1, 1), (2200, 13, 29))), unit
        )
        when = cftime.num2date(time, unit) + timedelta(seconds=30)
        assert dates.date(time, unit) == f"{when:%Y-%m-%d %H:%M}", (time, unit)


@pytest.mark.parametrize(
    ("unit", "expected"),
    [
        ("seconds", 1.0), ("minutes since 2000-01-01", 60.0), ("hrs", 3600.0), ("Days", 86_400.0),
        ("months since 2000-01-01", 2_629_746.0), ("years", 31_556_952.0), ("msec", 1e-3),
        ("steps", None), ("", None),
    ],
)  # fmt: skip
def test_lengths_of_units_of_time(unit, expected):
    assert dates.seconds(unit) == (expected and pytest.approx(expected))


@pytest.mark.parametrize(
    ("low", "high", "unit", "words"),
    [
        (0, 30, "hours since 2001-03-05 05:00", ["06:00", "12:00", "18:00", "2001-03-06", "06:00"]),
        (0, 10, "days since 2001-02-25", ["2001-02-26", "2001-03-01", "2001-03-06"]),
        (0, 90, "days since 2001-01-15", ["2001-02", "2001-03", "2001-04"]),
        (0, 36, "months since 2001-03-01", ["2002", "2003", "2004"]),
        (0, 730, "days since 0001-07-01, 365_day calendar", ["0002", "0003"]),
        (0, 30, "seconds since 2001-01-01", None),
        (0, 30, "days", None),
    ],
)
def test_round_dates_are_at_their_times(low, high, unit, words):
    """Each is at the time whose date it is, at midnight where no time is said."""
    if "calendar" in unit:
        pytest.importorskip("cftime")
    every = [*dates.round_dates(low, high, unit, 4)]
    assert (words is None and not every) or words in [[word for _, word in each] for each in every]
    for time, word in itertools.chain(*every):
        assert low <= time <= high
        whole = word + "0001-01-01 00:00"[len(word) :] if ":" not in word else word
        assert dates.date(time, unit).endswith(whole)
