"""``vizlight view FILE``: a page on this machine to tune a picture by eye."""

#: Address of this machine that no other one reaches.
HOST = "127.0.0.1"
