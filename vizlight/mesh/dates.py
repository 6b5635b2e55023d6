"""Dates and lengths of the times of files, by CF and by usage."""

from __future__ import annotations

import bisect
import math
import re
from collections.abc import Iterator, Sequence
from datetime import timedelta

import numpy as np

#: Days of a year, the mean of 400 years.
_YEAR = 365.2425
#: Seconds of the units of times, by patterns of their names.
_SECONDS = {
    r"(n|nano)(s|secs?|seconds?)": 1e-9, r"(u|µ|micro)(s|secs?|seconds?)": 1e-6,
    r"(m|milli)(s|secs?|seconds?)": 1e-3, "s|secs?|seconds?": 1.0, "mins?|minutes?": 60.0,
    "h|hrs?|hours?": 3600.0, "d|days?": 86_400.0, "weeks?": 604_800.0,
    "mons?|months?": _YEAR / 12 * 86_400, "y|yrs?|years?": _YEAR * 86_400,
}  # fmt: skip
#: Lengths in seconds between round dates; steps of their years and months, days of a month, and
#: steps of minutes; and letters of their words.
_ROUND = (
    *((60.0 * n, (1, 1, range(1, 32), n), 10) for n in (1, 5, 15, 30, 60, 180, 360, 720)),
    *((86_400.0 * n, (1, 1, range(1, 32 - n * (n > 1), n), 1440), 10) for n in (1, 2, 5, 10)),
    *((_YEAR * 7200 * n, (1, n, (1,), 1440), 7) for n in (1, 2, 3, 6)),
    *(
        (_YEAR * 86_400 * n, (n, 12, (1,), 1440), 4)
        for p in range(4)
        for n in (10**p, 2 * 10**p, 5 * 10**p)
    ),
)
#: Number of parts of a range: dates that differ by less are one.
_FINEST = 1 << 30
#: Unit of the numbers of months of no year, from 1 to 12.
MONTHS = "month of a year"
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

    Units are such as "hours since 1900-01-01".
    """
    name = unit.strip().lower().partition(" ")[0]
    return next((size for words, size in _SECONDS.items() if re.fullmatch(words, name)), None)


def date(time: float, unit: str) -> str:
    """Return the date of a time in words, to the minute, empty where its unit names no day.

    Months and years since a day are those of the calendar, and parts of them are parts of that
    month. Calendars of models, and days before 1582-10-15, need cftime, without which they are
    empty too. The unit is such as "hours since 1900-01-01 06:00, noleap calendar".
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


def round_dates(low: float, high: float, unit: str, most: int) -> Iterator[list[tuple[float, str]]]:
    """Yield round dates within a range of times and their words, ever fewer; none without a day.

    Words are those of a year, a month or a day, or of a time of a day, at midnight of the day.
    ``most`` is the largest number of dates, and the unit is as for :func:`date`.
    """
    first, last = date(low, unit), date(high, unit)
    long = (seconds(unit) or 0.0) * (high - low)
    for length, (years, months, days, minutes), digits in _ROUND if first and last else ():
        if long > (most + 1) * length:
            continue
        texts = [
            f"{day} {minute // 60:02}:{minute % 60:02}"
            for year in range(int(first[:4]), int(last[:4]) + 1)
            if year % years == 0
            for day in (f"{year:04}-{m:02}-{d:02}" for m in range(1, 13, months) for d in days)
            if first[:10] <= day <= last[:10]
            for minute in range(0, 1440, minutes)
        ]
        times = [(_when(text, low, high, unit), text) for text in texts if first <= text <= last]
        words = [
            (time, text[:digits] if text.endswith("00:00") else text[11:])
            for time, text in times
            # A day that a month has not is the next one.
            if date(time, unit) == text
        ]
        if len(words) > 1:
            yield words


def _when(text: str, low: float, high: float, unit: str) -> float:
    """Return the first time of a range that is not before a date, to a part of a minute."""
    step = (high - low) / _FINEST
    at = bisect.bisect_left(range(_FINEST), text, key=lambda i: date(low + i * step, unit))
    return low + at * step


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
