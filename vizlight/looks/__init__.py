"""From any data to a finished picture: its subject, its light and its camera."""
