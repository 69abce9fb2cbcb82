"""Life of a bearing: when a spall begins, and how it grows until the end. Pure functions of numbers and arrays, in SI units.

The load of the vibration model does not act on the growth: a larger spall raises the contact forces of a record, and not its own growth.

============= =================================================================
module        responsibility
============= =================================================================
fatigue       rating life by ISO 281 and the scatter of single lives
growth        growth of a spall along the rolling direction
ageing        slow histories of load and speed, and the life that follows
============= =================================================================
"""
