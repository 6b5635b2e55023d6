"""What a reader can read back from a picture: direction, order, sense, slope, shape and value."""
