"""Drawing of the best features of a ranking."""

from matplotlib import rc_context
from matplotlib.figure import Figure
from pandas import DataFrame

from features.ranking import MEASURES
from features.table.definitions import GROUPS
from raceway.reports.pictures import BLUE, INK, STYLE, WIDTH
from raceway.reports.summaries import TEST_MARKERS

DRAWN = 25  # features
COLOURS: dict[str, str] = dict(zip(GROUPS, (BLUE, *(colour for colour, _ in TEST_MARKERS)), strict=False))
TITLES = ("ANOVA F", "Kruskal-Wallis H", "mutual\ninformation [nat]", "permutation\nimportance")


@rc_context(STYLE)
def draw_ranking(ranked: DataFrame) -> Figure:
    """Measures of the best features of `features.rank_features` as bars, one panel each, coloured by group."""
    best = ranked.head(DRAWN)
    figure = Figure(figsize=(WIDTH, 1.1 + 0.17 * len(best)), layout="constrained")
    panels = figure.subplots(1, len(MEASURES), sharey=True)
    rows = range(len(best))
    for axes, measure, title in zip(panels, MEASURES, TITLES, strict=True):
        axes.barh(rows, best[measure], 0.7, color=[COLOURS[group] for group in best["group"]])
        axes.axvline(0, color=INK, linewidth=0.6)
        axes.set_title(title)
        axes.locator_params(axis="x", nbins=3)
        axes.spines["left"].set_visible(False)
        axes.tick_params(axis="y", length=0)
    panels[0].set_yticks(rows, [name.replace("_", " ") for name in best.index], fontsize=7)
    panels[0].set_ylim(len(best) - 0.4, -0.6)
    drawn = [group for group in GROUPS if (best["group"] == group).any()]
    handles = [panels[0].barh(0, 0, color=COLOURS[group]) for group in drawn]
    figure.legend(handles, drawn, loc="outside upper left", ncols=len(drawn))
    return figure
