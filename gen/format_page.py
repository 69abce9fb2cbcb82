"""Page in Markdown about the format, with tables generated from its schema."""

from collections.abc import Iterable

from gen.corpus.fault_classes import BUILT_IN
from gen.corpus.schema import FORMAT, ROLES, SCHEMA, SIGNAL, Variable, listed_flags
from gen.corpus.simulated import LIFE
from gen.corpus.unusable import CLIPPED_SHARE

_FORMAT = f"""# The corpus format, version {FORMAT}

A corpus is one netCDF-4 file, `NAME.nc`, or a folder of such files:

| file | content |
|---|---|
| `parts/part-00000.nc` ... | files of some hundred records, each with the layout of a corpus; a generated one of 40: `part-00007-40.nc` |
| `index.nc` | the variables and attributes of the single file, for all records, without the signal |
| `manifest.json` | records, bytes and SHA-256 of each part; whether the corpus is complete; where the records come from; its own hash |
| `recipe.yaml` | the recipe, if all records were generated from one |
| `README.md` | the [data card](sharing.md#the-data-card); `raceway card` adds `pictures/`, and `card.json` with captions and scores |
| `croissant.json` | files with SHA-256, variables, licence and citation in the format Croissant 1.1, for catalogues of data sets |

The commands write `README.md` and `croissant.json`; from Python `raceway.describe(corpus)` does.
The data card of a single file `NAME.nc` lies in `NAME.card/`. While a single file is being generated, its parts lie in
`NAME.nc.parts/`. An unfinished corpus lists no parts in its manifest: every whole part that lies in `parts/` counts.

**Checksum.** Every netCDF file of a corpus ends with a newline, then `sha256:` and the SHA-256 of all bytes before that
newline. HDF5 ignores bytes behind its own, so [all readers](sharing.md#which-programs-read-what) open the file.
`gen.open_corpus` compares files with their hashes before any library opens them, and refuses a missing or altered file.
A file that another program has rewritten, such as a copy by `nccopy`, has no such line: open it with
`gen.open_corpus(path, check="size")`. `sha256` in `manifest.json` is that of its other keys, as
`json.dumps(..., sort_keys=True)` writes them. `raceway validate` checks
[all but data card and pictures](security.md).

Facts about the records are fields of `manifest.json`, and global attributes of `index.nc` and of a single file, there
as JSON where they are not text:

| fact | content |
|---|---|
| `title`, `recipe` | title of the corpus, name of its recipe |
| `recipe_sha256` | hash of the recipe, if its parts are here as they were generated; `raceway generate` completes such a corpus |
| `sources_sha256`, `versions` | hash of the sources of Raceway that made the records; versions of Raceway, libraries and plug-ins |
| `records` | number of records |
| `parts_sha256` | hash over those of the parts; a single file has that of the parts that it was made of |
| `overrides` | `seed` and `records` that replaced those of the recipe, or null |
| `signals` | numbers of records that no analysis can use, by reason, see below |
| `importer`, `recordings` | importer, and number of the recordings |
| `basis`, `skipped`, `warnings` | sentences on what labels and units rest on, on skipped files, and on assumptions |
| `failures` | a sentence for each record that could not be simulated and is left out |
| `publication` | licence, creators and other facts of [publication](sharing.md) |
| `recipe_text` | attribute only: the recipe as in `recipe.yaml` |

Every file has `Conventions`, `raceway_format`, `title` and `history`. `index.nc` and single files have all facts;
`raceway.describe`, `publish` and `copy` add the attributes of [publication](sharing.md) to `index.nc`, `publish` alone
to a single file.

`signals` counts the records that no analysis can use: `clipped` if more than {CLIPPED_SHARE:.0%} of the samples of
a channel are at the ends of the converter, or in floating point at the largest and smallest value of the channel;
`dead` if all samples of a channel are zero, `constant` if they all have one other value, `not_finite` if a sample
is missing or not a number.

The signal is `{SIGNAL} (record, channel, elapsed_time)` in m s-2: 16-bit counts with `scale_factor`, which xarray
and netCDF4 apply when they read, or 32-bit floating point. Divided by `scale_factor` and rounded, the signal that these
readers return gives the counts exactly. Text is stored as fixed-length characters. In Python write
`corpus["load"]`: `corpus.load` is a method of xarray. Every other variable has one value
per record, and a `role`:

- `operating`: known to an analyst on site; features may use it,
- `label`: the target of a classifier,
- `latent`: known to the simulator alone,
- `provenance`: origin of the record.

`fault` is 127 (`unknown`) where the class of a recording is not known. That is no class: `raceway train`, `benchmark`
and `compare` leave such records out. Classes of [plug-ins](plugins.md) have codes from {len(BUILT_IN)} on, and
`flag_values` and `flag_meanings` of each file tell which.

Of imported corpora, two rigs can have a `specimen`, and two specimens a `recording`, of the same number.

Every corpus has the variables below; `gen.open_corpus` adds `fault_name` and `split_name`. It can have further ones,
numbers that are not packed or text, with a `long_name` and a `role`:

"""


_SIMULATED = """
Simulated records also have these; `draws` is the [recipe of the record alone](labels.md#one-record-as-a-recipe), as
JSON, from which `raceway replay` makes the record again. Where simulated and recorded records lie in one corpus,
recorded ones have NaN, -1, `unjudged` or empty text there:

"""


_LIFE = """
Records of a recipe with `life` are snapshots of [lives](lives.md), and also have these. `bearing` then names the single
bearing, so that it groups the snapshots of a life. A bearing is `censored` if its test ended before it failed:

"""


def format_page(simulated: Iterable[Variable]) -> str:
    """Markdown page about the format, with tables of the variables of all corpora, of ``simulated`` ones and of lives."""
    general = {variable.name for variable in SCHEMA}
    further = (variable for variable in simulated if variable.name not in general)
    tables = _table(SCHEMA), _table(sorted(further, key=lambda variable: ROLES.index(variable.role))), _table(LIFE)
    texts = _FORMAT, _SIMULATED, _LIFE
    return "".join(text + table for text, table in zip(texts, tables, strict=True))


def _table(variables: Iterable[Variable]) -> str:
    rows = ["| variable | type | unit | role | meaning |", "|---|---|---|---|---|"]
    for variable in variables:
        flags = f" ({listed_flags(variable.flags)})" if variable.flags else ""
        cells = (f"`{variable.name}`", variable.dtype, variable.units, variable.role, variable.long_name + flags)
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"
