"""The seed paper of Raceway, Ophel et al. (2025), reproduced: ``python -m studies.ophel2025 -o OUT``.

``preset -> displacements -> measures -> statements -> page``

=========== ======================================================================
module      responsibility
=========== ======================================================================
paper       the systems of the paper, with three sets of constants
measures    measures on displacements and spectra
experiments the one constant with which a statement of the paper holds
statements  the statements of the paper, measured
schematics  figures 1 and 2: the model, the cracked bearing
page        figures 3 to 6 drawn, and the statements, on one page
=========== ======================================================================
"""
