"""Readers of files: a table of formats, and one file for each family of them."""
