"""Pictures of records and of scores, and one page of a corpus and its benchmark.

========= =====================================================================
module    responsibility
========= =====================================================================
pictures  drawings of one record, of the contents of a corpus, and of scores
envelopes drawings of several envelope spectra: a grid, and a waterfall
examples  records of a corpus as pictures
page      a corpus and its benchmark on one page
========= =====================================================================
"""
