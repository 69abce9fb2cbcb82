"""Sizes of the model that the recipe checks and the kernel compiles in.

Pure numbers: a recipe can be read without loading the compiler.
"""

MAX_BALLS = 24
"""Most balls of a bearing."""
LOWEST_ORDER, HIGHEST_ORDER = 2, 60
"""Waviness orders per turn of a race."""
BALL_ORDERS = 10
"""Even waviness orders of a ball: 2, 4, ... 20."""
TABLE_POINTS = 513
"""Points of a tabulated spall, from edge to edge."""
