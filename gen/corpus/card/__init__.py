"""Data card of a corpus: a page in Markdown, made from the files of its folder alone.

========== ================================================================
module     responsibility
========== ================================================================
markdown   text of strangers without Markdown, tables
contents   counts of records by class and split, records that cannot be used
ranges     least, median and largest value of each quantity by class
labels     faults that can be seen, meanings
origin     how the corpus was made, how to make it again, what is left out
terms      licence, creators, how to cite
opening    how to open it in Python, MATLAB, R and Julia
additions  pictures and scores of ``card.json``
page       the whole page
========== ================================================================
"""
