"""Pictures of records and of scores, and pages: a corpus and its benchmark, a comparison, a diagnosis, a corpus to browse.

=============== ==================================================================
module          responsibility
=============== ==================================================================
class_colours   colours of the fault classes
pictures        drawings of one record, and the style of all
subject         what is drawn: a record, or a recording of the user
maps            drawings of kurtograms, order maps and coherence
views           one view of a record, over orders at any speed
bearing_drawing a bearing under load: its load zone, and the path of a point on a ball
summaries       drawings of the contents of a corpus, and of scores
curves          drawings of detection, false alarms and reliability
sides           drawings of several sets side by side: examples, and distributions
examples        an example of each class as a picture
templates       templates of pages
report_page     a corpus and its benchmark on one page
explore         a corpus on one page to browse
explore_command the command explore
=============== ==================================================================
"""
