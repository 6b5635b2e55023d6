"""From any data to a finished picture: what is shown, in which light, from where."""
