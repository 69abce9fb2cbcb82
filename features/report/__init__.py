"""Pictures of records and of scores, one page of a corpus and its benchmark, one of a comparison, and one of a diagnosis.

========== ======================================================================
module     responsibility
========== ======================================================================
pictures   drawings of one record, of the contents of a corpus, and of scores
envelopes  drawings of several envelope spectra: a grid, and a waterfall
curves     drawing of a learning curve
ranking    drawing of the best features of a ranking
sides      drawings of several sets side by side: examples, and distributions
examples   records of a corpus as pictures
templates  templates of pages
page       a corpus and its benchmark on one page
comparison a synthetic corpus and real ones on one page
diagnosis  a diagnosis on one page
========== ======================================================================
"""
