"""``croissant.json``: files, fields, licence and citation of a corpus as catalogues of data sets read them, in the format Croissant 1.1.

It lists the files with their SHA-256 and every variable with its type and meaning. A field names a file with its variable: readers of
Croissant find files and fields, and the files themselves are read with a netCDF reader. How the records came about is told in the
words of Croissant RAI 1.0 [1]_.

.. [1] M. Akhtar et al., "Croissant RAI specification", version 1.0, MLCommons, 2024.
"""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import xarray as xr

from gen.corpus.disk import CROISSANT_NAME, sha256, write_text_durably
from gen.corpus.fault_classes import FAULTS, HEALTHY
from gen.corpus.index import open_corpus
from gen.corpus.lazy import stored_classes
from gen.corpus.manifest import INDEX_NAME, MANIFEST_NAME, RECIPE_NAME, corpus_files, read_manifest
from gen.corpus.schema import DRAWS, SIGNAL, class_names, listed_flags
from gen.support.display import visible
from raceway.sharing.acdd import content_id, license_address, publication_attributes
from raceway.sharing.card.card_page import card_folder
from raceway.sharing.card.citation import citation
from raceway.sharing.publication import Publication, publication_of

_PARTS = {
    "@type": "cr:FileSet",
    "@id": "parts",
    "name": "parts",
    "description": "Parts of the corpus; each is complete and has some of the records.",
    "encodingFormat": "application/x-netcdf",
    "includes": "parts/*.nc",
}
# readers of Croissant refuse a creator of neither type, so that one who may be either has both
_CREATOR_TYPES = {
    "person": "sc:Person",
    "institution": "sc:Organization",
    None: ["sc:Person", "sc:Organization"],
}
_TERMS = (
    "arrayShape", "citeAs", "column", "containedIn", "equivalentProperty", "extract", "field", "fileObject", "fileProperty", "fileSet",
    "format", "includes", "isArray", "isLiveDataset", "jsonPath", "key", "md5", "parentField", "path", "recordSet", "references", "regex",
    "repeated", "replace", "samplingRate", "separator", "source", "subField", "transform",
)  # fmt: skip
_CONTEXT = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "description": {"@container": "@language"},
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "name": {"@container": "@language"},
    "rai": "http://mlcommons.org/croissant/RAI/",
    "sc": "https://schema.org/",
    **{name: f"cr:{name}" for name in _TERMS},
}
"""Words of the format with their addresses; its readers expect all of them in every file."""


def write_croissant(path: Path) -> None:
    """Write ``croissant.json`` of a finished corpus, whole or not at all; the same corpus gives the same bytes."""
    write_text_durably(croissant_text(path), card_folder(path) / CROISSANT_NAME)


def croissant_problems(path: Path) -> list[str]:
    """A sentence if ``croissant.json`` is not that of the corpus; a corpus without one has no problem."""
    file = card_folder(path) / CROISSANT_NAME
    if not file.is_file() or file.read_bytes() == croissant_text(path).encode():
        return []
    return [f"{file}: is not that of the corpus; run raceway card again."]


def croissant_text(path: Path) -> str:
    """Text of ``croissant.json`` of a finished corpus."""
    return json.dumps(_visible(croissant(path)), indent=1, ensure_ascii=False) + "\n"


def _visible(content: Any) -> Any:
    """Content of JSON, whose texts can come from strangers, without characters that are not seen."""
    if isinstance(content, dict):
        return {_visible(key): _visible(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_visible(value) for value in content]
    return visible(content) if isinstance(content, str) else content


def croissant(path: Path) -> dict[str, Any]:
    """Content of ``croissant.json`` of a finished corpus.

    Raises
    ------
    CorpusError
        If the corpus is unfinished, or one of its files is missing or of another size than in the manifest.
    """
    manifest = read_manifest(path)
    attributes = publication_attributes(manifest)
    files = {file.relative_to(path.parent if path.is_file() else path).as_posix(): file for file in _files(path)}
    # the manifest states those of the parts: hashing them again would read the whole corpus
    hashes = {f"parts/{row.name}": row.sha256 for row in manifest.parts}
    kinds = {".nc": "application/x-netcdf", ".json": "application/json", ".yaml": "application/yaml"}
    with open_corpus(path, check="size") as corpus:
        title = str(corpus.attrs.get("title", "Untitled corpus"))
        return {
            "@context": _CONTEXT,
            "@type": "sc:Dataset",
            "conformsTo": ["http://mlcommons.org/croissant/1.1", "http://mlcommons.org/croissant/RAI/1.0"],
            "name": title,
            "description": attributes["summary"],
            "keywords": attributes["keywords"].split(", "),
            "identifier": attributes["id"],
            # a version that follows from the content
            "version": f"1.0.0+{content_id(manifest)[:8]}",
            "isLiveDataset": False,
            **_publication_facts(publication_of(manifest)),
            **_origin_facts(corpus, manifest.basis, attributes["processing_level"]),
            "citeAs": citation(title, manifest),
            "distribution": [
                *(_file(name, file, kinds[file.suffix], hashes.get(name)) for name, file in files.items()),
                *([] if path.is_file() else [_PARTS]),
            ],
            "recordSet": [
                _records(
                    corpus,
                    stored_classes(corpus_files(path, "size")[-1]),
                    {"fileObject": {"@id": path.name}} if path.is_file() else {"fileSet": {"@id": "parts"}},
                ),
            ],
        }


def _publication_facts(publication: Publication) -> dict[str, Any]:
    """Licence, creators, publisher and dates, as far as they are given."""
    creators = []
    for creator in publication.creators:
        kind = _CREATOR_TYPES[publication.kind_of(creator)]
        address = {"url": f"https://orcid.org/{creator.orcid}"} if creator.orcid else {}
        creators.append({"@type": kind, "name": creator.name, **address})
    publisher = {"@type": "sc:Organization", "name": publication.institution}
    if publication.contact:
        publisher["email"] = publication.contact
    stated = {
        "license": license_address(publication.license) if publication.license else None,
        "creator": creators,
        "publisher": publisher if publication.institution else None,
        "url": f"https://doi.org/{publication.doi}" if publication.doi else None,
        "citation": list(publication.references),
        "dateCreated": publication.date,
        "datePublished": publication.date,
    }
    return {name: value for name, value in stated.items() if value}


def _origin_facts(corpus: xr.Dataset, basis: Sequence[str], level: str) -> dict[str, Any]:
    """How records and labels came about, and what they leave out, as far as the corpus knows it."""
    simulated = DRAWS in corpus.variables
    labels = ["Labels of simulated records are the values that were simulated."] if simulated else []
    limitation = "A score on simulated records is no score on real machines; test on recordings of them, too."
    healthy = int((corpus["fault"].values == FAULTS.index(HEALTHY)).sum())
    stated = {
        "dataCollection": "; ".join(filter(None, (level, corpus.attrs.get("source")))),
        "hasSyntheticData": simulated,  # younger than RAI 1.0, but asked for by conferences
        "dataAnnotationProtocol": " ".join([*labels, *basis]),
        "dataBiases": f"{healthy} of {corpus.sizes['record']} records are healthy, which is not their share in the field.",
        "dataLimitations": limitation if simulated else "",
    }
    return {f"rai:{name}": value for name, value in stated.items() if value}


def _files(path: Path) -> list[Path]:
    """Files of a corpus: the single file; or index, parts, manifest and recipe of a folder."""
    files = corpus_files(path, "size")
    if path.is_file():
        return files
    beside = [path / MANIFEST_NAME, path / RECIPE_NAME]
    return [path / INDEX_NAME, *files, *(file for file in beside if file.is_file())]


def _file(name: str, file: Path, kind: str, digest: str | None) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": name,
        "name": name,
        "contentUrl": name,
        "contentSize": f"{file.stat().st_size} B",
        "encodingFormat": kind,
        "sha256": digest or sha256(file),
    }


def _records(corpus: xr.Dataset, faults: Mapping[int, str], source: Mapping[str, Any]) -> dict[str, Any]:
    """Set of the records with a field for each variable, and the codes of ``faults`` in their files; the signal is one array."""
    names = [str(name) for name, variable in corpus.variables.items() if "role" in variable.attrs]
    channels = ", ".join(str(name) for name in corpus["channel"].values)
    return {
        "@type": "cr:RecordSet",
        "@id": "records",
        "name": "records",
        "description": f"Records of the corpus, one value of each variable for each; channels of the signal: {channels}.",
        "field": [_field(name, corpus.variables[name], faults, source) for name in names],
    }


def _field(name: str, variable: xr.Variable, faults: Mapping[int, str], source: Mapping[str, Any]) -> dict[str, Any]:
    attributes, text = variable.attrs, variable.dtype.kind not in "iuf"
    unit, codes = attributes.get("units", "1"), listed_flags(faults if name == "fault" else class_names(attributes))
    meaning = str(attributes.get("long_name", name)) + (f" [{unit}]" if unit != "1" else "")
    stored = "sc:Text" if text else f"cr:{variable.dtype.name.title().replace('Ui', 'UI')}"
    field: dict[str, Any] = {
        "@type": "cr:Field",
        "@id": f"records/{name}",
        "name": name,
        "description": f"{meaning} ({attributes.get('role', 'signal')})" + (f": {codes}" if codes else ""),
        "dataType": [stored, "cr:Label"] if name == "fault" else stored,
        "source": {**source, "extract": {"column": name}},
    }
    if name == SIGNAL:
        field |= {"isArray": True, "arrayShape": ",".join(str(size) for size in variable.shape[1:])}
    return field
