from .acceleration import Signal as Signal, read_signal as read_signal
from .assemble import Import as Import
from .generic import import_generic as import_generic
from .published import import_set as import_set
