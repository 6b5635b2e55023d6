"""The stability suite; ``.venv/bin/python tests/stability`` runs it."""
