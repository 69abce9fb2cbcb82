"""A machine imitated: from recordings of it with a healthy bearing to a recipe of its faults.

``recordings -> checks -> estimates -> recipe with comments -> healthy records of it beside the recordings``

=============== ==========================================================================
module          responsibility
=============== ==========================================================================
estimates       resonances, noise, lines and modulation of recorded segments [pure]
imitation       recordings checked and kept, and the recipe
nearness        healthy records of the recipe compared with the recordings, and their page
imitate_command the command imitate
=============== ==========================================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
