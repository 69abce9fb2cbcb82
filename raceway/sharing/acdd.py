"""Global attributes of a published corpus, as the Attribute Convention for Data Discovery (ACDD 1.3) names them.

Attributes without a fact behind them are left out, as are those about time and place on Earth, which a bearing on a test rig does not
have. No variable has a CF standard name (the table has none for vibration), so that no table of them is named.
"""

from uuid import NAMESPACE_OID, uuid5

from gen.corpus.manifest import Manifest
from gen.corpus.schema import FORMAT
from raceway.sharing.publication import Creator, publication_of

_KEYWORDS = (
    "bearing vibration, rolling bearing, bearing fault, fault diagnosis, condition monitoring, labelled recordings"
)
_SIMULATED = "simulated rotating machine", "simulated accelerometer", "simulated"
_RECORDED = "rotating machine", "accelerometer", "cut from recordings"
_BOTH = (
    "rotating machine, simulated rotating machine",
    "accelerometer, simulated accelerometer",
    "recorded and simulated",
)


def publication_attributes(manifest: Manifest) -> dict[str, str]:
    """Global attributes of ``index.nc``, of single files and of copies in other forms, beside those of the parts."""
    return {name: value for name, value in attributes_or_none(manifest).items() if value}


def attributes_or_none(manifest: Manifest) -> dict[str, str | None]:
    """All attributes that a corpus can have; they follow from its ``publication``, its counts and the hash of its parts."""
    publication = publication_of(manifest)
    recorded = _RECORDED if manifest.recipe is None else _BOTH
    platform, instrument, origin = _SIMULATED if manifest.importer is None else recorded
    creators = publication.creators
    kinds = {publication.kind_of(creator) for creator in creators}
    creator_type = kinds.pop() if len(kinds) == 1 else None
    publisher = publication.institution or ", ".join(creator.name for creator in creators)
    return {
        # what follows from the corpus itself
        "summary": f"{manifest.records} labelled records of bearing vibration, {origin}, with fault class, speed, load and nominal fault "
        f"frequencies of each.",
        "keywords": f"{_KEYWORDS}, {origin}",
        "id": publication.doi or content_id(manifest),
        "naming_authority": "https://doi.org" if publication.doi else "urn:uuid",
        "processing_level": f"acceleration in m s-2, {origin}",
        "product_version": _product_version(manifest),
        "platform": platform,
        "instrument": instrument,
        # what a person has to say, and may have left out
        "license": _license(publication.license),
        "creator_name": ", ".join(creator.name for creator in creators),
        "creator_type": creator_type,
        "creator_url": _addresses(creators),
        "creator_email": publication.contact,
        "creator_institution": publication.institution,
        "institution": publication.institution,
        "publisher_name": publisher,
        "publisher_type": "institution" if publication.institution else creator_type,
        "publisher_institution": publication.institution,
        "publisher_email": publication.contact,
        "references": "; ".join(publication.references),
        "metadata_link": f"https://doi.org/{publication.doi}" if publication.doi else None,
        "date_created": publication.date,
    }


def content_id(manifest: Manifest) -> str:
    """Number (UUID) that follows from the hashes of all parts: the same records have the same, under every publication."""
    return str(uuid5(NAMESPACE_OID, manifest.parts_sha256 or ""))


def license_address(name: str) -> str:
    """Address of the text of a licence; a licence of its own, or several, stay as they are.

    >>> license_address("CC-BY-4.0"), license_address("MIT OR Apache-2.0")
    ('https://spdx.org/licenses/CC-BY-4.0.html', 'MIT OR Apache-2.0')
    """
    own = name.startswith(("LicenseRef-", "(")) or " " in name
    return name if own else f"https://spdx.org/licenses/{name.removesuffix('+')}.html"


def _license(name: str | None) -> str | None:
    if name is None:
        return None
    address = license_address(name)
    return name if address == name else f"{name} ({address})"


def _addresses(creators: tuple[Creator, ...]) -> str:
    return ", ".join(f"https://orcid.org/{creator.orcid}" for creator in creators if creator.orcid)


def _product_version(manifest: Manifest) -> str:
    version = manifest.versions.get("raceway")
    return f"raceway {version}, format {FORMAT}" if version else f"raceway format {FORMAT}"
