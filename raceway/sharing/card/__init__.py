"""Data card of a corpus: a page in Markdown, made from the files of its folder alone by the template ``card.md.jinja``.

========== =================================================================
module     responsibility
========== =================================================================
markdown   text of strangers without Markdown
card_facts counts by class and split, ranges, meanings, how to make it again
citation   how to cite the corpus
additions  pictures and scores of ``card.json``
card_page  the whole page
========== =================================================================
"""
