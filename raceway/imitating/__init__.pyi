from .imitation import Imitation as Imitation, imitate as imitate
