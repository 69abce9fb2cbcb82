"""Results of a benchmark as JSON, with a digest of each row, so that a later benchmark takes over only rows that are as it wrote them."""

import json
from collections.abc import Mapping
from dataclasses import asdict, replace
from hashlib import sha256
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError

from features.baselines.results import Baseline, Results, setup
from gen.corpus import write_numbers

DIGESTS = "row_sha256"


def write_results(results: Results, path: Path) -> None:
    """Write results as JSON, whole or not at all."""
    content = asdict(results)
    as_read = TypeAdapter(Results).validate_python(content)  # whole numbers in place of decimals become decimals
    write_numbers(content | {DIGESTS: _digests(as_read)}, path)


def read_results(path: Path) -> Results | None:
    """Results in a file of `write_results`, without altered rows; None if there is no such file, or none of this version."""
    try:
        content = path.read_bytes()
        results, stored = TypeAdapter(Results).validate_json(content), json.loads(content)[DIGESTS]
        own = _digests(results)

        def whole(track: str, baselines: Mapping[str, Baseline]) -> dict[str, Baseline]:
            return {name: row for name, row in baselines.items() if stored[track].get(name) == own[track][name]}

        further = {track: replace(one, baselines=whole(track, one.baselines)) for track, one in results.further.items()}
        return replace(results, baselines=whole(results.track, results.baselines), further=further)
    except (OSError, ValidationError, KeyError, AttributeError):
        return None


def _digests(results: Results) -> dict[str, dict[str, str]]:
    """SHA-256 of each row with the corpora and settings of its results, by track and name of the classifier."""
    same = asdict(setup(results))
    of_tracks = {results.track: results.baselines} | {track: one.baselines for track, one in results.further.items()}
    return {
        track: {name: _sha256([same, track, name, asdict(row)]) for name, row in baselines.items()}
        for track, baselines in of_tracks.items()
    }


def _sha256(content: Any) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
