"""Figures of plotters as filled paths, strokes and words: SVG and PDF."""
