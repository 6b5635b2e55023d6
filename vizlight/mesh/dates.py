"""Dates and lengths of the times of files, by CF and by usage."""

from __future__ import annotations

import math
import re
from datetime import timedelta
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["date", "seconds"]

#: Days of a year, the mean of 400 years.
_YEAR = 365.2425
#: Seconds of the units of times, by patterns of their names.
_SECONDS = {
    r"(n|nano)(s|secs?|seconds?)": 1e-9, r"(u|µ|micro)(s|secs?|seconds?)": 1e-6,
    r"(m|milli)(s|secs?|seconds?)": 1e-3, "s|secs?|seconds?": 1.0, "mins?|minutes?": 60.0,
    "h|hrs?|hours?": 3600.0, "d|days?": 86_400.0, "weeks?": 604_800.0,
    "mons?|months?": _YEAR / 12 * 86_400, "y|yrs?|years?": _YEAR * 86_400,
}  # fmt: skip
#: Unit of times that are dates themselves, such as 20010215.5.
_ABSOLUTE = "day as %Y%m%d"
#: Unit and first day of times, such as "hours since 1900-1-1T6:00:00.0 +1:00".
_SINCE = re.compile(
    r"([a-z_]+) since (\d{1,4})-(\d\d?)-(\d\d?)"
    r"(?:[t ] *(\d\d?)(?::(\d\d?)(?::(\d\d?(?:\.\d*)?))?)?)?"
    r" *(?:z|utc|gmt|([+-])(\d\d?):?(\d\d)?)?",
    re.IGNORECASE,
)
#: First day of the Gregorian calendar, before which the standard one is that of Julius.
_REFORM = np.datetime64("1582-10-15")
#: Years that have four digits end here.
_LAST = np.datetime64("9999-12-31")


def seconds(unit: str) -> float | None:
    """Return the length of a unit of time in seconds; None where it is none.

    Parameters
    ----------
    unit : str
        Name of the unit, such as "hours since 1900-01-01".
    """
    name = unit.strip().lower().partition(" ")[0]
    return next((size for words, size in _SECONDS.items() if re.fullmatch(words, name)), None)


def date(time: float, unit: str) -> str:
    """Return the date of a time in words, to the minute, empty where its unit names no day.

    Months and years since a day are those of the calendar, and parts of them are parts of that
    month. Calendars of models, and days before 1582-10-15, need cftime, without which they are
    empty too.

    Parameters
    ----------
    time : float
        Time.
    unit : str
        Its unit and calendar, such as "hours since 1900-01-01 06:00, noleap calendar".
    """
    text, _, calendar = unit.strip().partition(", ")
    calendar = calendar.removesuffix(" calendar") or "standard"
    if text.startswith(_ABSOLUTE):
        digits = f"{int(time):08}"
        text, time = f"days since {digits[:4]}-{digits[4:6]}-{digits[6:]}", time % 1
    parts = _SINCE.fullmatch(text)
    try:
        if parts is not None and (minute := _minute(time, parts.groups(), calendar)) is not None:
            return str(minute).replace("T", " ")
        import cftime

        when = cftime.num2date(time, text, calendar)
        # To the nearest minute: a third of a day has no end in binary digits.
        when += timedelta(seconds=30)
    except (ImportError, ValueError, OverflowError):
        return ""
    return f"{when.year:04}-{when.month:02}-{when.day:02} {when.hour:02}:{when.minute:02}"


def _minute(time: float, parts: Sequence[str], calendar: str) -> np.datetime64 | None:
    """Return the nearest minute of a time after a day; None where NumPy has no such day.

    ``parts`` are those of :data:`_SINCE`: unit, year, month, day, hour, minute, second, and the
    sign, the hours and the minutes of a time zone.
    """
    name, sign = parts[0].lower(), -1 if parts[7] == "-" else 1
    year, month, day, hour, minute, zone, more = (
        int(part or 0) for part in (*parts[1:6], *parts[8:])
    )
    by_months = re.fullmatch("mon.*|y.*", name) is not None and calendar != "360_day"
    usual = calendar in ("standard", "gregorian", "proleptic_gregorian")
    size = seconds(name)
    if size is None or not (by_months or usual):
        return None
    minutes = 60 * (hour - sign * zone) + minute - sign * more + float(parts[6] or 0) / 60
    start = np.datetime64(f"{year:04}-{month:02}-01").astype("M8[M]")
    if by_months:
        months = time * (12 if name[0] == "y" else 1)
        start += np.timedelta64(math.floor(months), "M")
        days = (start + np.timedelta64(1, "M")).astype("M8[D]") - start.astype("M8[D]")
        minutes += months % 1 * 1440 * days.astype(np.float64)
    else:
        minutes += time * size / 60
    first = start.astype("M8[D]") + np.timedelta64(day - 1, "D")
    mixed = calendar != "proleptic_gregorian"
    if mixed and first < _REFORM and not by_months:
        # Days of the calendar of Julius, whose leap years are all of the fourth years.
        century = (year - (month < 3)) // 100
        first += np.timedelta64(century - century // 4 - 2, "D")
    result = first.astype("M8[m]") + np.timedelta64(round(minutes), "m")
    return None if result > _LAST or (mixed and result < _REFORM) else result
