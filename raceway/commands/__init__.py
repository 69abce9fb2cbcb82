"""The commands: each reads its options, calls ``gen``, ``features`` or a study, and shows what these return.

========= =====================================================================
module    responsibility
========= =====================================================================
corpora   commands that make corpora and look at them
importing commands that bring real recordings into the format
learning  commands from a corpus to features, models and a report
reproduce the seed paper run again
gallery   a page of pictures of what the model makes
========= =====================================================================

Heavy libraries are imported inside the commands, so that help and version answer at once.
"""
