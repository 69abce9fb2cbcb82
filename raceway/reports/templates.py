"""Self-contained pages from templates: pictures and styles are in the file, texts are escaped, and no other file is replaced."""

import base64
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from gen.corpus import check_result, write_text_durably
from gen.support.display import visible

LONGEST_TEXT = 300


def write_page(path: Path, name: str, package: str = "raceway.reports", /, **variables: Any) -> Path:
    """Write the page of a template, whole or not at all; CorpusError if it would replace something else, or the disk refuses it."""
    page = template(name, package).render(variables)
    check_result(path, "page")
    write_text_durably(page, path)
    return path


def template(name: str, package: str = "raceway.reports") -> jinja2.Template:
    """Template of a package. Filter ``image`` makes an address of a picture, ``figure`` three decimals, ``digits`` three digits.

    Texts are escaped, and without control and format characters.

    What a template includes, such as the style of all pages, is of this package.
    """

    def read(wanted: str) -> str:
        return files(package if wanted == name else "raceway.reports").joinpath(wanted).read_text(encoding="utf-8")

    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(read),
        # texts of a corpus come from strangers
        autoescape=True,
        # a misspelt variable is an error, not an empty place on a page
        undefined=jinja2.StrictUndefined,
        finalize=lambda value: visible(value) if isinstance(value, str) else value,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "figure": lambda value: "–" if value is None else f"{value:.3f}",
        "image": _address,
        "digits": three_digits,
    }
    return environment.get_template(name)


def short_text(value: object) -> str:
    """Text of a corpus without signs that are not seen, shortened."""
    text = visible(str(value))
    return text if len(text) <= LONGEST_TEXT else f"{text[:LONGEST_TEXT]}..."


def _address(picture: bytes) -> str:
    """Address that holds a picture in PNG or SVG."""
    kind = "png" if picture.startswith(b"\x89PNG") else "svg+xml"
    return f"data:image/{kind};base64,{base64.b64encode(picture).decode()}"


def three_digits(value: float) -> str:
    """Number without an exponent.

    >>> three_digits(1234.5), three_digits(0.001234), three_digits(float("nan"))
    ('1230', '0.00123', '–')
    """
    if not np.isfinite(value):
        return "–"
    return np.format_float_positional(value, precision=3, unique=False, fractional=False, trim="-")
