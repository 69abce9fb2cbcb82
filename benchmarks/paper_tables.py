"""Tables of docs/errata.md about the statements of the seed paper.

``python -m benchmarks.paper_tables`` prints them: the statements that the constants of the presets were not fitted to, and the experiments
on every statement that does not hold. tests/raceway/test_paper_experiments.py compares the page with them.
"""

from collections.abc import Iterator

from raceway.studies.experiments import EXPERIMENTS, Experiment, changed, worded
from raceway.studies.paper import PRESETS, Run, run_many
from raceway.studies.statements import findings, span


def further() -> Iterator[str]:
    """Statements that the constants of the presets were not fitted to, with their values for each preset."""
    yield f"| | statement | accepted | {' | '.join(f'`{name}`' for name in PRESETS)} |"
    yield "|---|---|---|" + "---:|" * len(PRESETS)
    found = [findings(name, made) for name, made in zip(PRESETS, run_many(list(PRESETS.values())), strict=True)]
    for same in zip(*found, strict=True):
        first = same[0]
        if not first.fitted:
            values = (f"{f.value:.3g}{'' if f.holds else ' **no**'}" for f in same)
            yield f"| {first.id} | {first.finding} | {span(first.accept)} | {' | '.join(values)} |"


def causes(holds: bool) -> Iterator[str]:
    """Experiments with which the statements hold, or those with which they still do not."""
    yield f"| preset | statements | change | value, with the change | {'why they fail without it' if holds else 'alleged cause'} |"
    yield "|---|---|---|---|---|"
    chosen = [each for each in EXPERIMENTS if each.holds == holds]
    before = dict(zip(PRESETS, run_many(list(PRESETS.values())), strict=True))
    after = run_many([changed(PRESETS[each.preset], each.change) for each in chosen])
    for each, made in zip(chosen, after, strict=True):
        values = ", ".join(_values(each, before[each.preset], made))
        yield f"| `{each.preset}` | {', '.join(each.statements)} | {worded(each)} | {values} | {each.why} |"


def _values(each: Experiment, before: Run, after: Run) -> Iterator[str]:
    old = {f.id: f.value for f in findings(each.preset, before)}
    new = {f.id: f.value for f in findings(each.preset, after)}
    yield from dict.fromkeys(f"{old[key]:.3g} to {new[key]:.3g}" for key in each.statements)


def main() -> None:
    """Print the tables."""
    print("\n".join([*further(), "", *causes(holds=True), "", *causes(holds=False)]))


if __name__ == "__main__":
    main()
