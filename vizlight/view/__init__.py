"""``vizlight view FILE``: a page on this machine to tune a picture by eye."""
