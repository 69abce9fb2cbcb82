"""What a recipe is made of, and how a value is drawn from it.

============= ========================================================
module        responsibility
============= ========================================================
expressions   distributions as text: loguniform(0.1, 2)
distributions distributions of drawn values
section       base of all sections: bounds, unknown keys, meanings
draws         draw values from the distributions of a section
============= ========================================================
"""
