"""Refuse recipes that cannot be made as a whole: keys that contradict each other, weights that cannot be met."""

from gen.mechanisms.mechanism import mechanisms_of
from gen.recipe.faults import fault_class
from gen.recipe.lives import life_problem
from gen.recipe.loads import load_problem
from gen.recipe.machine import CatalogueBearing
from gen.recipe.operation import OperationSection, Steps, Table
from gen.recipe.sections import Sections
from gen.recipe.shares import operations, share_problem
from gen.support.limits import check_limit

# memory of a record beside its signal, in samples of 12 bytes: 40 kB of drawn values, and 140 bytes per number of a table or trace
_SAMPLES_OF_A_RECORD, _SAMPLES_OF_A_NUMBER = 4000, 12


def check_recipe(recipe: Sections) -> None:
    """ValueError about the first reason for which a recipe cannot be made; gives every share the range of its product."""
    _check_sizes(recipe)
    problem = (
        _faults_problem(recipe)
        or _corpus_problem(recipe)
        or _sensing_problem(recipe)
        or _sensor_faults_problem(recipe)
        or share_problem(recipe)
        or next(filter(None, (_operation_problem(recipe, *item) for item in operations(recipe).items())), None)
        or life_problem(recipe)
    )
    if problem is not None:
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
    tables = [0]
    for entry in range(len(recipe.faults)):
        operation = recipe.operation_of(entry)
        profiles = (operation.speed_profile, operation.load_profile)
        tables.append(sum(2 * len(profile.times_s) for profile in profiles if isinstance(profile, Table)))
    return max(tables) + max(sum(part.n_numbers for part in fault.components) for fault in recipe.faults)


def _faults_problem(recipe: Sections) -> str | None:
    weights = {"healthy": 0.0, "faulty": 0.0}
    if recipe.corpus.fault_choice == "in_turn":
        for number, entry in enumerate(recipe.faults):
            if entry.weight != 1:
                return f"faults[{number}].weight: has no effect with corpus.fault_choice: in_turn; leave it out, or choose by_weight."
    for entry in recipe.faults:
        weights["healthy" if fault_class(entry) == "healthy" else "faulty"] += entry.weight
    if sum(weights.values()) == 0:
        return "faults all have weight 0; give at least one a weight above 0."
    for number, entry in enumerate(recipe.faults):
        if entry.level is not None and recipe.level.kind != "snr":
            return (
                f"faults[{number}].level: works with level.kind: snr alone, because a physical level is that of the rig; "
                f"leave it out, or use level.kind: snr."
            )
    return _rungs_problem(recipe, **weights)


def _rungs_problem(recipe: Sections, healthy: float, faulty: float) -> str | None:
    """Error sentence if the rungs are of no fault, or give more healthy records than the weights allow, else None."""
    rungs = recipe.corpus.rungs
    if rungs is None:
        return None
    if faulty == 0:
        return "corpus.rungs: no entry of faults with a weight above 0 has a severity; add a fault, or leave rungs out."
    at_least = faulty / (len(rungs) - 1)
    if recipe.corpus.fault_choice == "by_weight" and rungs[0] == 0 and healthy < at_least * (1 - 1e-9):
        return (
            f"corpus.rungs: rung 0 makes at least {100 / len(rungs):.3g} % of all records healthy, and the weights of faults ask for "
            f"{100 * healthy / (healthy + faulty):.3g} %; give kind: healthy a weight of {at_least:.6g} or more, or leave out rung 0."
        )
    return None


def _corpus_problem(recipe: Sections) -> str | None:
    corpus = recipe.corpus
    if recipe.origin is not None and (recipe.n_records, len(recipe.faults), recipe.life) != (1, 1, None):
        return "origin: is that of one record without life; keep one rig with one specimen, one record and one fault, or leave origin out."
    if recipe.origin is not None and (several := _several(recipe)) is not None:
        return f"{several}: one record, with an origin, has one of them; name it, or leave origin out."
    if recipe.truth.undetected == "redraw" and corpus.records_of_a_specimen > recipe.storage.records_per_part:
        return (
            f"truth.undetected: redraw judges all {corpus.records_of_a_specimen} records of a specimen together, and a part has "
            f"{recipe.storage.records_per_part}; raise storage.records_per_part, or choose keep."
        )
    if recipe.n_records % corpus.n_rungs:
        return (
            f"records: {recipe.n_records} ends within a group of {corpus.n_rungs} records, one for each of corpus.rungs; "
            f"use a multiple of {corpus.n_rungs}."
        )
    if corpus.split.validation + corpus.split.test >= 1:
        return "corpus.split: validation and test leave nothing to train on; make their sum less than 1."
    return None


def _several(recipe: Sections) -> str | None:
    """Key that names several of what one record has one of; None without one."""
    bearing, conditions = recipe.bearing, recipe.machine_conditions
    if isinstance(bearing, CatalogueBearing) and len(bearing.designations) > 1:
        return "bearing.designations"
    if conditions is not None and len(conditions.entries) > 1:
        return "machine_conditions.entries"
    bodies = (sum(weight > 0 for weight in channel.body.values()) for channel in recipe.recording.channels)
    return "recording.channels.body" if any(count > 1 for count in bodies) else None


def _sensor_faults_problem(recipe: Sections) -> str | None:
    loose = getattr(recipe.sensor_faults, "loose_mount", None)
    channels = len(recipe.recording.channels)
    if loose is not None and any(place >= channels for place in loose.loose_channels or ()):
        return f"sensor_faults.loose_mount.loose_channels: a record has {channels} channels, numbered from 0; name some of them."
    for fault in mechanisms_of(recipe.sensor_faults):
        problem = fault.problem(recipe.recording.full_scale, recipe.recording.duration_s)
        if problem is not None:
            return f"sensor_faults.{fault.place}.{problem}"
    return None


def _sensing_problem(recipe: Sections) -> str | None:
    recording = recipe.recording
    if recipe.machine.resonator is None and any("sensor" in channel.body for channel in recording.channels):
        return "recording.channels: body sensor needs machine.resonator; give one, or use body: housing."
    for place, path in [
        ("path", recipe.path),
        *((f"recording.channels[{n}].path", c.path) for n, c in enumerate(recording.channels)),
    ]:
        if path is not None and path.silent():
            return f"{place}.direct: 0 without modes transmits nothing; give modes or a direct part above 0."
    if recipe.n_samples < 16:
        return f"recording.duration_s: {recipe.n_samples} samples are too few; use at least 16."
    if len({channel.name for channel in recording.channels}) < len(recording.channels):
        return "recording.channels: two channels have the same name; give each its own."
    return None


def _operation_problem(recipe: Sections, place: str, operation: OperationSection) -> str | None:
    """Error sentence about the operating conditions at a place of the recipe: those of all records, or those of one fault."""
    if operation.axial_load_n.support()[1] > 0 and not _has_contact_angle(recipe):
        return (
            f"{place}.axial_load_n: needs a contact angle; give specimen.contact_angle_deg or a bearing that has one."
        )
    beyond = load_problem(recipe.bearing, recipe.specimen, operation, place)
    if beyond is not None:
        return beyond
    given = "temperature_celsius" in operation.model_fields_set and recipe.origin is None
    if given and recipe.contact.lubricant is None:
        return f"{place}.temperature_celsius: has no effect without oil; give contact.lubricant, or leave it out."
    duration = recipe.recording.duration_s
    for key, profile in (("speed", operation.speed_profile), ("load", operation.load_profile)):
        if isinstance(profile, Steps) and profile.step_s * len(profile.levels_percent) > duration:
            return (
                f"{place}.{key}_profile.step_s: {profile.step_s:g} s is longer than a level; keep it below "
                f"{duration / len(profile.levels_percent):.3g}."
            )
    return None


def _has_contact_angle(recipe: Sections) -> bool:
    """Whether some bearing has a contact angle."""
    bearing = recipe.bearing
    angles = {0.0, *recipe.specimen.contact_angle_deg.support()}
    if isinstance(bearing, CatalogueBearing):
        angles |= {bearing.bearing(designation).contact_angle for designation in bearing.designations}
    else:
        angles |= set(bearing.contact_angle_deg.support())
    return angles != {0.0}
