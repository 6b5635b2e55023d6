"""How wrong the light is: a second implementation, and the light between points."""
