"""What happens in a machine and its measuring chain, one mechanism a file: the keys of a recipe, the draw, the effect and the labels.

================ =====================================================================
module           responsibility
================ =====================================================================
mechanism        what a mechanism of a recipe is
path             transfer path from bearing to sensor: resonances and modulation
faults           faults of a bearing
background       noise of a machine, and sources of vibration beside its bearings
chain            faults of the measuring chain
mechanism_labels variables of the corpus that tell what mechanisms did
================ =====================================================================
"""
