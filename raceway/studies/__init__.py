"""Studies that need both ``gen`` and ``features``.

=============== ======================================================================
module          responsibility
=============== ======================================================================
paper           the seed paper: its systems run
schematics      figures 1 and 2 of the seed paper: the model, the cracked bearing
measures        measures on displacements and spectra
experiments     the one constant with which a statement of the paper holds
statements      the statements of the seed paper, measured
paper_page      the seed paper on one page: figures 3 to 6 drawn, statements
feature_page    tables and picture of docs/features.md
card_pictures   pictures and scores of a data card
timing          speed of this machine, stage by stage
doctor          facts of this machine, with advice
reference_model models trained on a recipe, and the one kept per user
=============== ======================================================================
"""
