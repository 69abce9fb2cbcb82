"""Templates of pages."""

import base64
from importlib.resources import files

import jinja2
import numpy as np

from gen.support.display import visible


def template(name: str, package: str = "raceway.reports") -> jinja2.Template:
    """Template of a package; filter ``image`` makes an address of a picture, ``figure`` three decimals or a dash.

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
    environment.filters["figure"] = lambda value: "–" if value is None else f"{value:.3f}"
    environment.filters["image"] = _address
    return environment.get_template(name)


def _address(picture: bytes) -> str:
    """Address that holds a picture in PNG or SVG."""
    kind = "png" if picture.startswith(b"\x89PNG") else "svg+xml"
    return f"data:image/{kind};base64,{base64.b64encode(picture).decode()}"


def three_digits(value: float) -> str:
    """Number without an exponent.

    >>> three_digits(1234.5), three_digits(0.001234)
    ('1230', '0.00123')
    """
    return np.format_float_positional(value, precision=3, unique=False, fractional=False, trim="-")
