from .comparison import Comparison as Comparison, compare as compare
