"""Exceptions on the way from a recipe to a corpus, one class per stage.

Each carries one sentence: where, what was found, what is allowed, what to do. The command line prints it as it stands.
"""


class RacewayError(Exception):
    """Anything a user can set right."""


class RecipeError(RacewayError):
    """A recipe that cannot be read or asks for what cannot be."""


class SimulationError(RacewayError):
    """A scenario that cannot be integrated as asked."""


class CorpusError(RacewayError):
    """A corpus that is missing, damaged or not in the format."""


class ClusterError(RacewayError):
    """A dask cluster that does not answer, or has lost its scheduler or its workers."""
