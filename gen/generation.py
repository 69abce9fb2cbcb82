"""Generate a corpus from a recipe, part by part, on one machine or many.

One task draws, simulates, measures and writes one part and returns its row of the manifest. The row is appended to the journal, so that
the same call completes an interrupted corpus: a part is kept if manifest or journal list it with the size and hash of the file; every
other part is made again.
"""

import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from gen.compilation import compile_kernels
from gen.corpus import (
    EXTENSION_NAME,
    JOURNAL_NAME,
    Extension,
    PartRow,
    SignalCounts,
    check_name,
    extensions_of,
    finish_corpus,
    locked,
    new_journal,
    part_name,
    read_manifest,
    remove_temporary_files,
    write_durably,
    write_manifest,
)
from gen.errors import CorpusError, RecipeError
from gen.making import Crew
from gen.part_task import Outcome, library_versions, make_parts, units
from gen.progress import Progress
from gen.recipe import Recipe, find_recipe, read_recipe, recipe_hash
from gen.workers import stream, threads_of

if TYPE_CHECKING:
    from distributed import Client


@dataclass(frozen=True)
class Generated:
    """Result of :func:`generate`."""

    directory: Path
    records: int
    parts: int
    kept: int
    """Number of parts that were kept from an earlier call."""
    failures: tuple[str, ...]
    """One sentence for each record that is left out because it could not be simulated."""
    signals: SignalCounts
    """Number of records that cannot be used."""


def generate(
    recipe: Path | str,
    directory: Path | str,
    *,
    workers: int = 1,
    scheduler: str | None = None,
    seed: int | None = None,
    records: int | None = None,
    progress: Progress | None = None,
    notice: Callable[[str], None] = lambda _: None,
) -> Generated:
    """Generate a corpus, or complete an interrupted one.

    Parameters
    ----------
    recipe : path or str
        Recipe file, or name of a recipe that ships with Raceway.
    directory : path
        Folder of the corpus; created if it does not exist. It must be empty or hold the same corpus, unfinished or finished.
    workers : int
        Number of parts that are made at a time: 1 in this thread, some in threads of this process, more in processes on this machine.
    scheduler : str, optional
        Address of a dask scheduler whose workers see ``directory`` under the same path; replaces ``workers``.
    seed, records : int, optional
        Replace the seed and the number of records of the recipe.
    progress : callable, optional
        Called in this thread with the number of records done and of all records. The last record of a part counts when the part is
        written, every other record when it is simulated.
    notice : callable, optional
        Called with a sentence when a kernel is about to be compiled.

    Raises
    ------
    RecipeError, SimulationError
        If the recipe cannot be simulated.
    CorpusError
        If the folder holds something else, or a file cannot be written.
    ClusterError
        If the scheduler does not answer or has no workers, before anything is written; or if the cluster is lost.
    """
    checked = read_recipe(recipe, seed=seed, records=records)
    directory = Path(directory)
    with client_of(scheduler, workers) as client, claimed(directory):
        extensions = _extensions(directory)
        checked = checked.extended(extensions)
        facts = facts_of(
            checked, {"seed": seed, "records": records} | ({"extensions": extensions} if extensions else {})
        )
        known = _prepare(directory, Path(find_recipe(recipe)), facts)
        tally = Tally(checked, progress)
        outcomes = finished_parts(tally, directory, known, workers, client, notice)
        return finished(directory, outcomes, facts)


def finished_parts(
    tally: "Tally",
    directory: Path,
    known: dict[str, PartRow],
    workers: int,
    client: "Client | None",
    notice: Callable[[str], None],
) -> list[Outcome]:
    """Make the parts of a tally that are missing, with a new journal; outcomes of all of them in their order."""
    recipe = tally.recipe
    if client is None and len(known) < len(tally.parts):
        compile_kernels(recipe, notice)
    outcomes: dict[int, Outcome] = {}
    with new_journal(directory) as append, closing(_made(tally, directory, known, workers, client)) as made:
        for part, outcome in made:
            outcomes[part] = outcome
            if outcome.row.records and not outcome.kept:
                append(outcome.row)
            tally.note(part, len(recipe.records_of_part(part)))
            tally.show()
    return [outcomes[number] for number in sorted(outcomes)]


def finished(
    directory: Path,
    outcomes: list[Outcome],
    facts: dict[str, Any],
    before: Sequence[PartRow] = (),
    failures: Sequence[str] = (),
) -> Generated:
    """Write index, manifest and data card of the finished parts, and of parts ``before`` them, of which ``failures`` are left out."""
    rows = [outcome.row for outcome in outcomes if outcome.row.records]
    if not rows:
        raise CorpusError(f"{directory}: no record could be simulated; {outcomes[0].failures[0]}")
    rows = [*before, *rows]
    failed = (*failures, *(sentence for outcome in outcomes for sentence in outcome.failures))
    facts = facts | {"publication": facts["publication"].dated()}
    signals = finish_corpus(directory, rows, failures=failed, **facts)
    (directory / JOURNAL_NAME).unlink()
    kept = sum(outcome.kept for outcome in outcomes)
    return Generated(directory, sum(row.records for row in rows), len(rows), kept, failed, signals)


def _extensions(directory: Path) -> tuple[Extension, ...]:
    """Extensions of the corpus in a folder that were finished; none if it holds no corpus.

    Raises
    ------
    CorpusError
        If an extension is unfinished.
    """
    if (directory / EXTENSION_NAME).exists():
        raise CorpusError(f"{directory}: is being extended; run the raceway extend command that began it again.")
    if not (directory / "manifest.json").exists():
        return ()
    return extensions_of(read_manifest(directory))


@contextmanager
def claimed(directory: Path) -> Iterator[None]:
    """Create the folder and lock it against other calls."""
    check_name(directory)
    if directory.exists() and not directory.is_dir():
        raise CorpusError(f"{directory}: is a file; give a folder for the corpus.")
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be written ({error}); choose another folder.") from None
    with locked(directory):
        yield


def _prepare(directory: Path, recipe_path: Path, facts: dict[str, Any]) -> dict[str, PartRow]:
    """Prepare the folder, and return the rows of the parts that may be kept, by name.

    The manifest is written first: it tells a corpus without any part from a folder that holds something else. It lists the parts that may
    be kept, and the journal of an earlier call is removed.
    """
    known: dict[str, PartRow] = {}
    journal = directory / JOURNAL_NAME
    begun = (directory / "manifest.json").exists()
    try:
        remove_temporary_files(directory)
        manifest = read_manifest(directory) if begun else None
        if manifest is not None and manifest.scenarios is not None:
            raise CorpusError(
                f"{directory}: holds some records of a recipe, or scenarios made by hand, so it cannot be generated; choose another folder."
            )
        if manifest is not None and (manifest.selections or manifest.origins):
            how = "selected from a larger corpus" if manifest.selections else "merged from several corpora"
            raise CorpusError(f"{directory}: was {how}, so it cannot be generated; choose another folder.")
        if manifest is not None and any((directory / "parts").glob("*.nc")):
            if manifest.recipe_sha256 != facts["recipe_sha256"]:
                raise CorpusError(
                    f"{directory}: holds a corpus of another recipe, seed or size; choose another folder."
                )
            if manifest.versions == facts["versions"]:  # other versions may write other bytes
                known = {row.name: row for row in manifest.parts}
            if not facts["publication"].stored:
                facts["publication"] = manifest.publication  # given after the corpus was made
        elif manifest is None and any(directory.iterdir()):
            raise CorpusError(f"{directory}: is not empty and holds no corpus; choose another folder.")
        if not known:
            journal.unlink(missing_ok=True)  # first: no row of other versions may stand beside the new manifest
        write_manifest(directory, known.values(), complete=False, **facts)
        journal.unlink(missing_ok=True)
        write_durably(recipe_path.read_bytes(), directory / "recipe.yaml")
        (directory / "parts").mkdir(exist_ok=True)
    except OSError as error:
        raise CorpusError(f"{directory}: cannot be written ({error}); choose another folder.") from None
    return known


def facts_of(recipe: Recipe, overrides: dict[str, Any]) -> dict[str, Any]:
    """Fields of the manifest that say where a generated corpus comes from."""
    return {
        "title": recipe.title,
        "recipe": recipe.name,
        "recipe_sha256": recipe_hash(recipe),
        "overrides": overrides,
        "publication": recipe.publication,
        "versions": library_versions(),
    }


class Tally:
    """Number of records that are done, of all parts or of some; it is changed by the thread that listens to the workers too."""

    def __init__(self, recipe: Recipe, progress: Progress | None, parts: range | None = None) -> None:
        self.recipe = recipe
        self.parts = range(recipe.n_parts) if parts is None else parts
        self._progress = progress
        self._of_parts = dict.fromkeys(self.parts, 0)
        self._all = sum(len(recipe.records_of_part(part)) for part in self.parts)
        self._done = 0  # their sum, which takes longer to compute the more parts there are
        self._lock = threading.Lock()

    def note(self, part: int, records: int) -> None:
        """Set the count of a part; a task that dask repeats does not lower it."""
        with self._lock:
            added = max(0, records - self._of_parts[part])
            self._of_parts[part] += added
            self._done += added

    def show(self) -> None:
        """Call ``progress`` with the number of records done, once it is not 0."""
        if self._progress is not None and self._done:
            self._progress(self._done, self._all)

    def note_and_show(self, part: int, records: int) -> None:
        """Set the count of a part and call ``progress``."""
        self.note(part, records)
        self.show()


def client_of(scheduler: str | None, workers: int) -> "AbstractContextManager[Client | None]":
    """Client of the scheduler at an address; None if no address is given, but a number of workers that must be 1 or more."""
    if workers < 1:
        raise RecipeError(f"workers: {workers} is not allowed; use 1 or more.")
    if scheduler is None:
        return nullcontext()
    from gen import cluster  # distributed takes 0.3 s to load, and work in this process does not need it

    return cluster.client_of(scheduler)


def _made(
    tally: Tally, directory: Path, known: dict[str, PartRow], workers: int, client: "Client | None"
) -> Generator[tuple[int, Outcome]]:
    """Number and outcome of every part in the order in which they finish: from this process, a local cluster or ``client``."""
    recipe, parts = tally.recipe, tally.parts
    numbered = {part: known[part_name(part)] for part in parts if part_name(part) in known}
    of_this_process = Crew(threads_of(workers))
    processes = workers // of_this_process.threads
    if client is None and processes == 1:
        report = tally.note_and_show if workers == 1 else tally.note
        for some in units(recipe, parts, 1):
            yield from make_parts(recipe, some, directory, numbered, report, tally.show, of_this_process)
        return
    from gen.cluster import local_client

    with local_client(processes) if client is None else nullcontext(client) as cluster:
        crew, count = of_this_process, processes
        if client is not None:
            threads: list[int] = list(cast("Any", client).nthreads().values())
            crew, count = Crew(1, 1 / max(threads, default=1)), max(sum(threads), 1)
        tasks = (
            (some, {part: numbered[part] for part in some if part in numbered}) for some in units(recipe, parts, count)
        )
        task = partial(_unit, recipe, directory.resolve(), crew)
        yield from stream(task, tasks, scheduler=cluster, report=tally.note, meanwhile=tally.show)


def _unit(
    recipe: Recipe,
    directory: Path,
    crew: Crew,
    report: Callable[[int, int], None],
    task: tuple[range, dict[int, PartRow]],
) -> Iterator[tuple[int, Outcome]]:
    parts, known = task
    return make_parts(recipe, parts, directory, known, report, crew=crew)
