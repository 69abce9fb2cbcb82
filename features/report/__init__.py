"""Pictures of records and of scores, and one page that holds them.

========= =====================================================================
module    responsibility
========= =====================================================================
pictures  records, scores and contents drawn
envelopes envelope spectra of several classes, and waterfalls
page      a corpus and its benchmark on one page
========= =====================================================================
"""
