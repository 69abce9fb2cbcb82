"""How much one bearing of the model may have; recipe and kernel share these numbers."""

MAX_BALLS = 64
LOWEST_ORDER, HIGHEST_ORDER = 2, 60  # waviness per turn of a race: order 0 is clearance, order 1 eccentricity
BALL_ORDERS = 10  # even orders of ball waviness from 2 on: a ball has two contacts, and odd orders cancel between them
TABLE_POINTS = 513  # of a tabulated spall, from edge to edge
