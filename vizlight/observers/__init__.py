"""How much a reader reads back from a picture: direction, order, sense, slope, shape and value."""
