"""Templates of pages."""

import base64
from importlib.resources import files

import jinja2


def template(name: str) -> jinja2.Template:
    """Template of this package; filter ``image`` makes an address of a picture in SVG, ``figure`` three decimals or a dash."""
    folder = files("features.report")
    environment = jinja2.Environment(
        loader=jinja2.FunctionLoader(lambda wanted: folder.joinpath(wanted).read_text(encoding="utf-8")),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["figure"] = lambda value: "–" if value is None else f"{value:.3f}"
    environment.filters["image"] = lambda svg: f"data:image/svg+xml;base64,{base64.b64encode(svg).decode()}"
    return environment.get_template(name)
