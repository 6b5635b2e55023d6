"""How wrong the light is: a second implementation, and the report that compares with it."""
