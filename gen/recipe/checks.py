"""Refuse recipes that cannot be made as a whole: keys that contradict each other, weights that cannot be met."""

from collections.abc import Iterator

from gen.mechanisms.background.noise import Noise
from gen.mechanisms.mechanism import mechanisms_of
from gen.recipe.faults import class_of
from gen.recipe.life_checks import life_problems
from gen.recipe.loads import contact_angles, load_problems
from gen.recipe.machine import CatalogueBearing
from gen.recipe.operation import Steps, Table
from gen.recipe.sections import Sections
from gen.recipe.shares import ranges, share_problems
from gen.support.limits import check_limit
from gen.support.rounding import rounded_up

# memory of a record beside its signal, in samples of 12 bytes: 40 kB of drawn values, and 140 bytes per number of a table or trace
_SAMPLES_OF_A_RECORD, _SAMPLES_OF_A_NUMBER = 4000, 12


def check_recipe(recipe: Sections) -> None:
    """ValueError about the first reason for which a recipe cannot be made."""
    _check_sizes(recipe)
    checks = (
        _faults,
        _corpus,
        _sensing,
        _sensor_faults,
        _recorded_background,
        share_problems,
        _operation,
        life_problems,
    )
    for problem in (problem for check in checks for problem in check(recipe)):
        raise ValueError(problem)


def _check_sizes(recipe: Sections) -> None:
    """Check counts and sizes before anything is drawn; the limits keep the memory of a part to a few gigabytes."""
    corpus, recording = recipe.corpus, recipe.recording
    # checked even if records: ends the corpus early, because the splits are drawn over all of its rigs
    place = "corpus: rigs * specimens_per_rig * records_per_specimen" + (" * rungs" if corpus.rungs else "")
    check_limit("records", corpus.n_records, f"{place} are", ValueError)
    check_limit("records", recipe.n_records, "records: asks for", ValueError)
    check_limit("rig_specimens", corpus.specimens_per_rig, "corpus.specimens_per_rig: asks for", ValueError)
    seconds = recording.settle_s + recording.duration_s
    samples = round(seconds * recording.sample_rate_hz) * len(recording.channels)
    check_limit("record_samples", samples, "recording: a record of all channels, settle_s included, has", ValueError)
    records = min(recipe.n_records, recipe.storage.records_per_part)
    of_a_record = samples + _SAMPLES_OF_A_RECORD + _SAMPLES_OF_A_NUMBER * _numbers_of_a_record(recipe)
    check_limit("part_samples", records * of_a_record, f"storage.records_per_part: {records} records need", ValueError)


def _numbers_of_a_record(recipe: Sections) -> int:
    """Count of the numbers of profiles and traces that each record holds."""
    tables = [
        sum(
            2 * len(profile.times_s)
            for profile in (conditions.speed_profile, conditions.load_profile)
            if isinstance(profile, Table)
        )
        for conditions in recipe.operations().values()
    ]
    return max(tables) + max(sum(part.n_numbers for part in fault.components) for fault in recipe.faults)


def _faults(recipe: Sections) -> Iterator[str]:
    weights = {"healthy": 0.0, "faulty": 0.0}
    for number, entry in enumerate(recipe.faults):
        weights["healthy" if class_of(entry) == "healthy" else "faulty"] += entry.weight
        if recipe.corpus.fault_choice == "in_turn" and entry.weight != 1:
            yield f"faults[{number}].weight: has no effect with corpus.fault_choice: in_turn; leave it out, or choose by_weight."
        if entry.level is not None and recipe.level.kind != "snr":
            yield (
                f"faults[{number}].level: works with level.kind: snr alone, because a physical level is that of the rig; "
                f"leave it out, or use level.kind: snr."
            )
    healthy, faulty = weights.values()
    if healthy + faulty == 0:
        yield "faults all have weight 0; give at least one a weight above 0."
    rungs = recipe.corpus.rungs
    if rungs is None:
        return
    if faulty == 0:
        yield "corpus.rungs: no entry of faults with a weight above 0 has a severity; add a fault, or leave rungs out."
    # rung 0 makes one of so many records healthy, whatever the weights say
    at_least = faulty / (len(rungs) - 1)
    if recipe.corpus.fault_choice == "by_weight" and rungs[0] == 0 and healthy < at_least * (1 - 1e-9):
        yield (
            f"corpus.rungs: rung 0 makes at least {100 / len(rungs):.3g} % of all records healthy, and the weights of faults ask for "
            f"{100 * healthy / (healthy + faulty):.3g} %; give kind: healthy a weight of "
            f"{rounded_up(at_least)} or more, or leave out rung 0."
        )


def _corpus(recipe: Sections) -> Iterator[str]:
    corpus = recipe.corpus
    # the recipe of one record has one of everything
    if recipe.origin is not None:
        if (recipe.n_records, len(recipe.faults), recipe.life) != (1, 1, None):
            yield (
                "origin: is that of one record without life; keep one rig with one specimen, one record and one fault, or leave origin "
                "out."
            )
        for several in _several(recipe):
            yield f"{several}: one record, with an origin, has one of them; name it, or leave origin out."
    if recipe.truth.undetected == "redraw" and corpus.records_of_a_specimen > recipe.storage.records_per_part:
        yield (
            f"truth.undetected: redraw judges all {corpus.records_of_a_specimen} records of a specimen together, and a part has "
            f"{recipe.storage.records_per_part}; raise storage.records_per_part, or choose keep."
        )
    if recipe.n_records % corpus.n_rungs:
        yield (
            f"records: {recipe.n_records} ends within a group of {corpus.n_rungs} records, one for each of corpus.rungs; "
            f"use a multiple of {corpus.n_rungs}."
        )
    if corpus.split.validation + corpus.split.test >= 1:
        yield "corpus.split: validation and test leave nothing to train on; make their sum less than 1."


def _several(recipe: Sections) -> Iterator[str]:
    """Keys that name several of what one record has one of."""
    bearing = recipe.bearing
    if isinstance(bearing, CatalogueBearing) and len(bearing.designations) > 1:
        yield "bearing.designations"
    if any(sum(weight > 0 for weight in channel.body.values()) > 1 for channel in recipe.recording.channels):
        yield "recording.channels.body"


def _sensor_faults(recipe: Sections) -> Iterator[str]:
    loose = getattr(recipe.sensor_faults, "loose_mount", None)
    channels = len(recipe.recording.channels)
    if loose is not None and (named := loose.loose_channels) is not None:
        if len({*named} & {*range(channels)}) < len(named):
            yield f"sensor_faults.loose_mount.loose_channels: a record has {channels} channels, from 0; name some, each once."
        if loose.probability < 1:
            yield "sensor_faults.loose_mount.probability: does not act on channels that are named; set it to 1."
    for fault in mechanisms_of(recipe.sensor_faults):
        problem = fault.problem(recipe.recording.full_scale, recipe.recording.duration_s)
        if problem is not None:
            yield f"sensor_faults.{fault.place}.{problem}"


def _sensing(recipe: Sections) -> Iterator[str]:
    channels = recipe.recording.channels
    if recipe.machine.resonator is None and any("sensor" in channel.body for channel in channels):
        yield "recording.channels: body sensor needs machine.resonator; give one, or use body: housing."
    paths = {
        "path": recipe.path,
        **{f"recording.channels[{n}].path": channel.path for n, channel in enumerate(channels)},
    }
    for place, path in paths.items():
        if path is not None and path.silent():
            yield f"{place}.direct: 0 without modes transmits nothing; give modes or a direct part above 0."
    if recipe.n_samples < 16:
        yield f"recording.duration_s: {recipe.n_samples} samples are too few; use at least 16."
    if len({channel.name for channel in channels}) < len(channels):
        yield "recording.channels: two channels have the same name; give each its own."


def _recorded_background(recipe: Sections) -> Iterator[str]:
    recorded = recipe.background.recording
    if recorded is None:
        return
    drawn = sorted(Noise.model_fields.keys() & recipe.background.model_fields_set)
    # a record that was drawn has every key of its background
    if drawn and recorded.probability == 1 and recipe.origin is None:
        yield f"background.{drawn[0]}: has no effect with a recording in place of the noise; leave one of the two out."
    if not recipe.truth.twins:
        yield "truth.twins: without them it is not known what a fault adds to background.recording; leave twins: false out."
    if recipe.n_specimens > recorded.stretches:
        yield (
            f"background.recording.stretches: {recorded.stretches} are too few for {recipe.n_specimens} specimens, each of which "
            "has one of its own; lower corpus.rigs or records, shorten recording.duration_s and raise it, or give a longer recording."
        )


def _operation(recipe: Sections) -> Iterator[str]:
    """Sentences about the operating conditions of all records, then of those of single faults."""
    reach, duration = ranges(recipe), recipe.recording.duration_s
    angles = {*reach["specimen"]["contact_angle_deg"], *contact_angles(recipe.bearing)}
    for place, operation in recipe.operations().items():
        if reach[place]["axial_load_n"][1] > 0 and angles == {0.0}:
            yield f"{place}.axial_load_n: needs a contact angle; give specimen.contact_angle_deg or a bearing that has one."
        yield from load_problems(recipe.bearing, operation, reach, place)
        # a key without an effect is a misunderstanding
        states_temperature = "temperature_celsius" in operation.model_fields_set and recipe.origin is None
        if states_temperature and recipe.contact.lubricant is None:
            yield f"{place}.temperature_celsius: has no effect without oil; give contact.lubricant, or leave it out."
        for key in ("speed_profile", "load_profile"):
            profile = getattr(operation, key)
            if isinstance(profile, Steps) and profile.step_s * len(profile.levels_percent) > duration:
                yield (
                    f"{place}.{key}.step_s: {profile.step_s:g} s is longer than a level; keep it below "
                    f"{duration / len(profile.levels_percent):.3g}."
                )
