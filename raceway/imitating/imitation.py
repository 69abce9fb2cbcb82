"""Recordings of a machine with a healthy bearing, turned into a recipe of its faults.

Recordings are read and diagnosed, and then kept as a corpus beside the recipe, or estimated and not kept.
"""

import math
import re
import shutil
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from features.baselines.predictions import UNSURE
from gen.corpus import check_new, check_result, sha256, temporary_folder, whole_or_not_at_all, write_text_durably
from gen.corpus.fault_classes import HEALTHY
from gen.generation.writing import write_corpus
from gen.physics.bearing import Bearing, orders
from gen.physics.bearing_text import bearing_from_text
from gen.physics.catalogue import known_designation
from gen.recipe import Recipe
from gen.support.errors import CorpusError, RecipeError
from gen.support.units import rpm_to_hertz
from gen.support.yaml_files import parse_yaml
from raceway.diagnosis import diagnose_recording, given_of
from raceway.diagnosis.quality import FEWEST_TURNS
from raceway.imitating.estimates import background_keys
from raceway.imitating.nearness import write_nearness
from raceway.importing.reading_options import Reading, speeds_in
from raceway.importing.recorded import Recorded
from raceway.importing.user_folder import read_recording
from raceway.kept_models import reference_model
from raceway.reports.templates import template

LONG = 60.0  # s, of a recording from which on a record lasts 1 s, and else half of it


class Imitation(NamedTuple):
    """The recipe, the kept recording or None, the page that compares both, the AUC of each measure there, and warnings."""

    recipe: Path
    recording: Path | None
    page: Path
    auc: dict[str, float | None]
    warnings: tuple[str, ...]


def imitate(
    recordings: Path | str | Sequence[Path | str],
    output: Path | str,
    *,
    bearing: str,
    rpm: float | Sequence[float] | None = None,
    load_n: float | None = None,
    synthetic: bool = False,
    **reading: Any,
) -> Imitation:
    """Write a recipe of a machine from recordings of it with a healthy bearing.

    Parameters
    ----------
    recordings : path or list of paths
        Files of one machine, of the kinds that ``raceway diagnose`` reads, with the same channels and sample rate.
    output : path
        The recipe, ``NAME.yaml``. ``NAME.nc`` keeps the recording, and ``NAME.html`` compares both.
    bearing : str
        Designation such as ``"6205"``, or a geometry such as ``"n_balls=8,pitch_diameter_mm=33.5,ball_diameter_mm=7.938"``.
    rpm : float or pair, optional
        Speed of the shaft, or its lowest and highest; by default the one that the first file states.
    load_n : float, optional
        Radial load of the bearing. With it and a known unit, the level of a fault is that of the model.
    synthetic : bool
        Estimate the background, and keep nothing of the recording.
    **reading
        How files are read: ``unit``, ``sensitivity``, ``rate``, ``channels``, ``variable`` and others of ``Reading``.

    Raises
    ------
    CorpusError, RecipeError
        If a file cannot be used, files differ, the speed is missing, or an output exists.
    """
    paths = [Path(recordings)] if isinstance(recordings, Path | str) else [*map(Path, recordings)]
    recipe, kept, page = (Path(output).with_suffix(suffix) for suffix in (".yaml", ".nc", ".html"))
    for path in (recipe, page):
        check_result(path, None)
    check_new(kept)
    drawing, geometry = bearing_from_text(bearing), known_designation(bearing)
    if drawing.printed_orders is not None:
        raise CorpusError(f"bearing: {bearing} has no geometry, which records need; give its dimensions.")
    how = Reading(**{"channels": (), **dict.fromkeys(Reading._fields[1:7]), **reading})
    signals, notes = list[Recorded](), list[str]()
    for path in paths:
        recorded, _, told = read_recording(path, how)
        signals.append(recorded)
        notes += told
    first, unit_known = signals[0], not any("states no unit" in note for note in notes)
    speed = first.rpm if rpm is None else rpm
    if speed is None:
        raise CorpusError(f"{first.name}: does not state its speed; give it with --rpm RPM.")
    try:
        speeds = speeds_in("-".join(f"{each}" for each in np.ravel(speed)))
    except ValueError as error:
        raise CorpusError(f"rpm: {error}.") from None
    rate, duration = rpm_to_hertz(sum(speeds) / 2), _duration(signals, min(speeds))
    notes += _doubts(signals, drawing, speeds)
    # every recording is as long as the shortest, and cut into segments of the length of a record
    samples, n = min(len(next(iter(each.signals.values()))) for each in signals), round(duration * first.fs)
    x = np.stack([[channel[:samples] for channel in each.signals.values()] for each in signals])
    segments = x[:, 0, : samples // n * n].reshape(-1, n)
    with temporary_folder() as folder:
        labels = {"fault": HEALTHY, "specimen": 0, "shaft_rate": rate, **orders(drawing)._asdict()}
        corpus = write_corpus(x, folder / kept.name, fs=first.fs, labels=labels)
        text = template("machine.yaml.jinja", "raceway.imitating").render(
            sources=[f"{path.name}, SHA-256 {sha256(path)}" for path in paths],
            name=re.sub(r"[^A-Za-z0-9_.-]", "_", recipe.stem)[:64],
            title=f"Bearing faults in the machine of {paths[0].name}"[:200],
            segments=len(segments),
            fs=first.fs,
            rate_given=how.rate is not None,
            duration=duration,
            channels=[re.sub(r"[^A-Za-z0-9_.-]", "_", name).strip("_")[:64] or "sensor" for name in first.signals],
            bearing=geometry or dict(part.split("=") for part in bearing.split(",")),
            speeds=speeds,
            given=rpm is not None,
            load=load_n,
            unit_known=unit_known,
            background=background_keys(segments, first.fs, rate),
            rms=float(np.sqrt(np.mean(x**2))),
            recording=None if synthetic else {"file": str(kept), "sha256": sha256(corpus)},
        )
        drawn = parse_yaml(text, recipe, RecipeError)
        if not synthetic:
            drawn["background"]["recording"]["file"] = str(corpus)
        auc = write_nearness(Recipe(drawn), segments, corpus, folder / page.name)
        # nothing is kept before all of it is there
        results = {page: folder / page.name} if synthetic else {page: folder / page.name, kept: corpus}
        for target, source in results.items():
            with whole_or_not_at_all(target) as temporary:
                shutil.copyfile(source, temporary)
        write_text_durably(text, recipe)
    return Imitation(recipe, None if synthetic else kept, page, auc, tuple(dict.fromkeys(notes)))


def _duration(recordings: Sequence[Recorded], rpm: float) -> float:
    """Length of a record [s]; CorpusError if recordings differ, or are shorter than two records."""
    first, *others = recordings
    for other in others:
        if (other.fs, [*other.signals]) != (first.fs, [*first.signals]):
            raise CorpusError(
                f"{other.name}: has another sample rate or other channels than {first.name}; imitate each."
            )
    shortest = min(recordings, key=lambda each: each.duration)
    least = math.ceil(10 * FEWEST_TURNS / rpm_to_hertz(rpm)) / 10
    duration = max(1.0 if shortest.duration >= LONG else 0.5, least)
    if shortest.duration < 2 * duration:
        message = f"lasts {shortest.duration:.3g} s, less than two records of {duration:g} s at {rpm:.4g} rpm"
        raise CorpusError(f"{shortest.name}: {message}; check the speed, or record {20 * duration:g} s or more.")
    return duration


def _doubts(recordings: Sequence[Recorded], drawing: Bearing, speeds: Sequence[float]) -> Iterator[str]:
    """Sentences on recordings that may be clipped, at another speed or not healthy; CorpusError if one tells nothing."""
    model, machine = reference_model(), given_of({drawing.designation: orders(drawing)}, speeds)
    for recorded in recordings:
        diagnosis, name = diagnose_recording(recorded.used, machine, model), Path(recorded.name).name
        if diagnosis.spectrum is None:
            raise CorpusError(
                f"{recorded.name}: cannot be imitated. {' '.join((diagnosis.sentence, *diagnosis.advice))}"
            )
        yield from (f"{name}: {warning}" for warning in diagnosis.warnings)
        # a comb that the given speed does not explain is that of a fault too
        if diagnosis.verdict not in (HEALTHY, UNSURE) or diagnosis.elsewhere:
            yield f"{name}: may be no healthy recording, and then its fault is in every record. {diagnosis.sentence}"
