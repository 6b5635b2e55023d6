"""Light that follows the camera of a plotter, at the points or in each fragment."""
