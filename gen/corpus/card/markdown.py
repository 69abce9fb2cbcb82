"""Markdown of a data card: text of strangers made harmless, and tables."""

from collections.abc import Iterable, Sequence


def plain_text(text: object) -> str:
    """Text from a stranger as one line without Markdown: no tag, link, picture, code or table cell.

    >>> plain_text("a|b <script> [x](http://y)  `z` ")
    "a/b (script) [x] (http://y) 'z'"
    """
    shown = " ".join(str(text).translate(_HARMLESS).split())
    shown = "".join(letter if letter.isprintable() else "?" for letter in shown)
    for link in ("](", "][", "]:"):
        shown = shown.replace(link, f"] {link[1]}")
    return shown


def code_text(text: object) -> str:
    """Text from a stranger as one line of a code block, which ends at the first line of back ticks.

    >>> code_text("fault == 'inner' and load < 5 ```")
    "fault == 'inner' and load < 5 '''"
    """
    shown = " ".join(str(text).replace("`", "'").split())
    return "".join(letter if letter.isprintable() else "?" for letter in shown)


_HARMLESS = str.maketrans({"|": "/", "<": "(", ">": ")", "`": "'", "\\": "/"})


def table(header: Sequence[str], rows: Iterable[Sequence[object]], *, right: int = 0) -> list[str]:
    """Lines of a table whose last ``right`` columns are aligned right; an empty line comes first.

    >>> table(("fault", "records"), [("inner", 3)], right=1)
    ['', '| fault | records |', '|---|---:|', '| inner | 3 |']
    """
    rules = ["---"] * (len(header) - right) + ["---:"] * right
    lines = [_row(header), f"|{'|'.join(rules)}|", *map(_row, rows)]
    return ["", *lines]


def _row(cells: Sequence[object]) -> str:
    return f"| {' | '.join(map(str, cells))} |"


def enumeration(words: Sequence[str]) -> str:
    """Words joined for a sentence.

    >>> enumeration(["a"]), enumeration(["a", "b", "c"])
    ('a', 'a, b and c')
    """
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
