"""Drawing of the best features of a ranking."""

from matplotlib import rc_context
from matplotlib.figure import Figure
from pandas import DataFrame

from raceway.reports.pictures import BLUE, INK, STYLE, WIDTH

DRAWN = 25  # features


@rc_context(STYLE)
def draw_ranking(ranked: DataFrame) -> Figure:
    """Importance of the best features of `features.rank_features` as bars, with its deviation over the folds."""
    best = ranked.head(DRAWN)[::-1]
    figure = Figure(figsize=(WIDTH, 0.8 + 0.17 * len(best)), layout="constrained")
    axes = figure.subplots()
    names = [f"{name} ({group})".replace("_", " ") for name, group in best["group"].items()]
    axes.barh(names, best["importance"], 0.7, xerr=best["deviation"], color=BLUE, ecolor=INK)
    axes.set_xlabel("loss of balanced accuracy when the values of the feature are permuted")
    axes.tick_params(axis="y", length=0, labelsize=7)
    return figure
