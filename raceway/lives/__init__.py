"""Remaining life of bearings from a feature table of their lives: estimates with and without the signal, and their scores.

============== ========================================================
module         responsibility
============== ========================================================
survival       pure: survival curves of censored lives, after their age
prognosis      estimates of remaining life, tested on other bearings
early_warning  alarms of detectors, and their delay
life_pictures  pictures of a life
lives_commands the commands life and prognose
============== ========================================================
"""
