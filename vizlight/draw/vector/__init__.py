"""Figures of plotters as filled paths, strokes and words: SVG and PDF."""

#: File name extensions of vector graphics.
VECTORS = (".svg", ".pdf")
