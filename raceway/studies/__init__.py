"""Studies that need both ``gen`` and ``features``.

=============== ======================================================================
module          responsibility
=============== ======================================================================
feature_page    tables and picture of docs/features.md
card_pictures   pictures and scores of a data card
timing          speed of this machine, stage by stage
reference_model models trained on a recipe, and the one kept per user
=============== ======================================================================
"""
