from .assemble import Import as Import
from .cwru import import_cwru as import_cwru
from .femto import import_femto as import_femto
from .generic import import_generic as import_generic
from .mfpt import import_mfpt as import_mfpt
from .acceleration import Signal as Signal, read_signal as read_signal
