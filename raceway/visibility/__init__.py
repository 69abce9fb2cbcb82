"""The smallest fault that can be seen: in which share of records a fault is seen, over its size.

``recipe or corpus -> feature table -> scores of records by twin and by classifier -> curve over the size, with intervals -> Limits``

============= ==========================================================
module        responsibility
============= ==========================================================
size_curves   pure: curve of the share seen, and sizes seen in a share
fault_limits  limits of each class from a recipe, a corpus or a table
limit_picture picture of the share seen over the size
limit_command the command limit
============= ==========================================================
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
