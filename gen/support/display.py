"""Objects that show what they hold: one line in a list, lines in print, a table in a notebook."""

from collections.abc import Iterable, Mapping
from html import escape
from unicodedata import category, normalize


class _Visible(dict[int, int | None]):
    """Translation of characters, looked up once: control and format characters and surrogates are left out, line breaks and tabs stay."""

    def __missing__(self, code: int) -> int | None:
        hidden = category(chr(code)) in ("Cc", "Cf", "Cs") and chr(code) not in "\n\t"
        self[code] = None if hidden else code
        return self[code]


_VISIBLE = _Visible()


def visible(text: str) -> str:
    r"""Text without characters that are not seen, such as marks of the direction of writing, which could make a title read otherwise.

    >>> visible("ball\u202e and\x1b outer\n")
    'ball and outer\n'
    """
    return text.translate(_VISIBLE)


def cell_text(text: str) -> str:
    """Text for one cell of a CSV file: no control characters, and no formula, which a spreadsheet would run.

    >>> cell_text("6205"), cell_text("=1+1"), cell_text("a" + chr(10) + "b")
    ('6205', "'=1+1", 'a?b')
    """
    shown = "".join(letter if letter.isprintable() else "?" for letter in text)
    # some spreadsheets also take signs of full width
    return f"'{shown}" if normalize("NFKC", shown).lstrip().startswith(("=", "+", "-", "@")) else shown


def first_few(texts: Iterable[str], most: int, between: str = ", ") -> str:
    """First texts of a list, and the number of the others.

    >>> first_few("abcd", 2), first_few("ab", 2)
    ('a, b and 2 more', 'a, b')
    """
    every = [*texts]
    more = f" and {len(every) - most:,} more" if len(every) > most else ""
    return between.join(every[:most]) + more


class Shown:
    """Base class of such objects: a heading, and facts by name; those without a value are left out."""

    def _heading(self) -> str:
        raise NotImplementedError

    def _facts(self) -> Mapping[str, object]:
        raise NotImplementedError

    def __repr__(self) -> str:
        """Heading alone."""
        return f"<{self._heading()}>"

    def __str__(self) -> str:
        """Heading and facts, one per line."""
        return "\n".join([self._heading(), *lines(self._facts())])

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th style="text-align:left">{escape(name)}</th><td style="text-align:left">{escape(visible(value))}</td></tr>'
            for name, value in _stated(self._facts()).items()
        )
        return f"<b>{escape(visible(self._heading()))}</b><table>{rows}</table>"


def lines(facts: Mapping[str, object]) -> list[str]:
    """Names and values, one pair per line; a pair without a value is left out.

    >>> lines({"records": 448, "split": "", "seed": 0})
    ['records  448', 'seed     0']
    """
    stated = _stated(facts)
    width = max(map(len, stated), default=0)
    return [f"{name.ljust(width)}  {value}" for name, value in stated.items()]


def _stated(facts: Mapping[str, object]) -> dict[str, str]:
    return {name: str(value) for name, value in facts.items() if value not in (None, "", ())}
