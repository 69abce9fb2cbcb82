"""Importers: recordings of real machines, converted into the corpus format.

=============== ===========================================================
module          responsibility
=============== ===========================================================
published       published sets, of patterns of paths and tables of labels
generic         recordings described by a table of labels
label_tables    tables of labels, and the keys that all rows share
label_keys      keys of one file of recordings
speed_tables    table of the speeds of the recordings in a folder
assumptions     sentences on what labels and units rest on
resampling      recordings brought to another sample rate
acceleration    one recording of the user, in m/s^2
recorded        a recording in memory
user_folder     recordings of the user: files of a folder, channels of each
reading_options options of commands that say how recordings are read
conversion      from the unit of a file to m/s^2
matlab          one variable of a MATLAB file or a NumPy archive
text_files      texts: encoding, lines, mark between columns, fields
sheets          sheets of spreadsheets, as tables in text
table           header, rows and notes of a table, parsed once by pandas
header          names, units and sample rate in the header of a table
numerals        numbers in text, and the decimal mark that suits them
speed_course    recordings sampled again at equal angles of the shaft
axes            columns that hold the axes of one sensor
columns         choice of a column, and the sample rate that times tell
array_files     NumPy, WAV, Parquet, TDMS and universal files
refused_files   reasons why a file cannot be used; errors of libraries
recordings      recordings, their checks, their division into records
assemble        recordings written as a corpus
import_commands commands that convert recordings
=============== ===========================================================

An importer lists its files with a function that reads each (:class:`~raceway.importing.recordings.Candidate`); ``assemble`` reads them one
after the other. A file that cannot be used is skipped as a whole, with a sentence.
"""

import lazy_loader

# one recording is read without the format of corpora, whose libraries take a second to load
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
