"""What a reader can read back from a lit picture: direction, slope, shape and value."""
