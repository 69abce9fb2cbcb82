"""Progress of an export, and the page about it."""

from collections.abc import Callable, Mapping
from typing import Any

from gen.corpus.card.markdown import plain_text
from gen.progress import Progress, counter
from gen.sharing.exporting.choosing import Block, Chosen

Report = Callable[[Block], None]
"""Called after each block that is written."""

_TERMS = {"license": "Licence", "creator_name": "Creators", "references": "References", "metadata_link": "Published at"}
"""Global attributes that the page repeats, with their headings."""


def reporter(chosen: Chosen, progress: Progress | None) -> Report:
    """Function that counts the records of finished blocks and passes on their number and that of all."""
    done = counter(progress, len(chosen.records))
    return lambda block: done(len(block.numbers))


def page(chosen: Chosen, reading: str) -> str:
    """README.md of an export: its origin, its size, and how to read it."""
    facts = chosen.corpus.attrs
    signal = f"{chosen.samples / chosen.sample_rate:g} s at {chosen.sample_rate:g} Hz"
    channels = ", ".join(map(plain_text, chosen.channel_texts))
    count = f"{len(chosen.records)} of {chosen.corpus.sizes['record']} records of a corpus"
    about = f"{count}, {signal}, channels {channels}, in m s-2, exported by Raceway. `record` is their number in the corpus."
    lines = [f"# {title(facts)}", "", about]
    for name, heading in _TERMS.items():
        text = plain_text(facts.get(name, ""))
        lines += ["", f"{heading}: {text}"] if text else []
    return "\n".join([*lines, "", reading])


def title(facts: Mapping[str, Any]) -> str:
    """Title of a corpus as one harmless line."""
    return plain_text(facts.get("title", "")) or "Vibration records of rolling bearings"
