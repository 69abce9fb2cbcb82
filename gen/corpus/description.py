"""Page in Markdown about the format, with tables generated from its schema."""

from gen.corpus.schema import FORMAT, SCHEMA, SIGNAL, Variable, listed_flags
from gen.corpus.signals import CLIPPED_SHARE
from gen.corpus.simulated import SIMULATED

_FORMAT = f"""# The corpus format, version {FORMAT}

A corpus is a folder:

| file | content |
|---|---|
| `corpus.nc` | all per-record variables, and the signal as an HDF5 virtual dataset over the parts: most readers see one file |
| `parts/part-00000.nc` ... | complete netCDF-4 files of some hundred records each |
| `manifest.json` | whether the corpus is complete; bytes and SHA-256 of `corpus.nc` and of each part; where the records come from |
| `parts.jsonl` | while the corpus is unfinished: one line for each finished part, as in `parts` of the manifest |
| `extension.json` | while the corpus is being extended: its manifest as it will be, with the finished new parts |
| `recipe.yaml` | the recipe, if the corpus was simulated |
| `recipes/` | the recipes of the corpora that were merged; `origins` of the manifest tells which records have which |
| `README.md` | the [data card](data-card.md); `raceway card` adds `pictures/`, and `card.json` with captions and scores |
| `croissant.json` | files with SHA-256, variables, licence and citation in the format Croissant 1.1, for catalogues of data sets |

HDF5 reads a part that it cannot open as missing values, without an error: a part that is missing, or that exceeds
the number of files a process may open. `gen.open_corpus` therefore compares every file with the manifest before it
reads, refuses a missing or altered file, and reads the signal from the parts. `raceway validate` checks everything.
Further checks of a corpus from strangers: [security.md](security.md).

`corpus.nc` without its parts holds no signals, and its attribute `comment` says so. `raceway pack` makes one file of the
whole corpus, with the variables below, without a virtual dataset, and with a SHA-256 of each record: a packed file.

ncdump, NCO, Octave, h5py, netCDF4 and xarray read `corpus.nc` in its folder, parts and packed files. R's ncdf4 and
`nccopy` read parts and packed files, but not `corpus.nc`. CDO reads all three without their text variables. MATLAB was
not tried. [sharing.md](sharing.md#which-programs-read-what) has the versions, and the layout of a packed file.

Other fields of the manifest tell where the records come from; each is there only if it has something to tell:

| field | content |
|---|---|
| `title`, `recipe`, `recipe_sha256` | title of the corpus, name of its recipe and hash of that |
| `versions` | versions of Raceway and its libraries |
| `overrides` | `seed` and `records` that replaced those of the recipe; `extensions`: rigs or specimens that were added later |
| `scenarios` | `chosen`: the records are some of those of the recipe; `given`: their scenarios were made by hand |
| `importer`, `recordings` | importer, and number of the recordings |
| `basis`, `skipped`, `warnings` | sentences on what labels and units rest on, on skipped files, and on assumptions |
| `failures` | a sentence for each record that could not be simulated and is left out |
| `selections` | choices by which the records were taken from a larger corpus, with a hash of the parts of that corpus |
| `origins` | of a merged corpus: the corpora that it was made from, each with its parts, its recipe and what was added to its numbers |
| `publication` | licence, creators and other facts of [publication](publishing.md) |
| `next_index` | while `raceway card` replaces `corpus.nc`: size and hash of the new one |

Every file has the global attributes `Conventions`, `raceway_format`, `title`, `history` and `source`; simulated parts
also have `recipe_sha256`, `versions` and `failures`. `corpus.nc` repeats those of the first part except `failures`, and
adds `comment` and the attributes of [publication](publishing.md).

`signals` counts the records that no analysis can use: `clipped` if more than {CLIPPED_SHARE:.0%} of the samples of
a channel are at the ends of the converter, or in floating point at the largest and smallest value of the channel;
`dead` if all samples of a channel are zero, `constant` if they all have one other value, `not_finite` if a sample
is missing or not a number.

The signal is `{SIGNAL} (record, channel, elapsed_time)` in m s-2: 16-bit counts with `scale_factor`, which xarray
and netCDF4 apply when they read, or 32-bit floating point. `scale_factor` and `add_offset` are 32-bit floating point,
and so is the signal that these readers return; divided by `scale_factor` and rounded, it gives the counts exactly. In
older corpora both are 64-bit, and so is what readers return. Text is stored as fixed-length characters. Every other
variable has one value per record, and a `role`:

- `operating`: known to an analyst on site; features may use it,
- `label`: the target of a classifier,
- `latent`: known to the simulator alone,
- `provenance`: origin of the record.

`fault` is 127 (`unknown`) where the class of a recording is not known. That is no class: `raceway train`, `benchmark`
and `compare` leave such records out.

Every corpus has the variables below. It can have further ones, numbers that are not packed or text, with a
`long_name` and a `role`:

"""


_SIMULATED = """
A corpus that `raceway generate` made also has these; `draws` holds every drawn value of the record, by the names of
the recipe's keys:

"""


def format_page() -> str:
    """Markdown page about the format; its tables are the schemas of all and of simulated corpora."""
    return _FORMAT + _table(SCHEMA) + _SIMULATED + _table(SIMULATED)


def _table(variables: tuple[Variable, ...]) -> str:
    rows = ["| variable | type | unit | role | meaning |", "|---|---|---|---|---|"]
    for variable in variables:
        flags = f" ({listed_flags(variable.flags)})" if variable.flags else ""
        cells = (f"`{variable.name}`", variable.dtype, variable.units, variable.role, variable.long_name + flags)
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows) + "\n"
