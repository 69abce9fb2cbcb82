"""Tables of pages, which stand between ``<!-- table: NAME -->`` and ``<!-- end of table -->``; tests compare the pages with them."""

import re
from collections.abc import Callable, Iterable, Sequence

_TABLE = re.compile(r"(<!-- table: (\S+) -->\n).*?(<!-- end of table -->)", re.DOTALL)
LEFT, RIGHT = "---", "---:"


def filled(page: str, table: Callable[[str], str]) -> str:
    """A page with its tables made again, by their names."""
    return _TABLE.sub(lambda marker: f"{marker[1]}\n{table(marker[2])}\n{marker[3]}", page)


def markdown(header: Sequence[str], rows: Iterable[Sequence[str]], align: str = LEFT) -> str:
    """A table whose columns but the first are aligned."""
    lines = (header, [LEFT, *[align] * (len(header) - 1)], *rows)
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
