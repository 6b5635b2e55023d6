"""Arrays of equal lengths, which are selected and joined as one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from typing_extensions import Self

    from vizlight._types import Bools, Indices


@dataclass
class Columns:
    """Base class of rows whose fields are arrays, or such rows themselves."""

    def __getitem__(self, rows: Indices | Bools | slice) -> Self:
        """Return some of the rows."""
        return type(self)(*(column[rows] for column in vars(self).values()))

    def joined(self, *others: Self) -> Self:
        """Return these rows and then others."""
        columns = zip(*(vars(part).values() for part in (self, *others)), strict=True)
        return type(self)(
            *(
                first.joined(*rest)
                if isinstance(first, Columns)
                else np.concatenate([first, *rest])
                for first, *rest in columns
            )
        )
