"""How each kind of data is drawn: functions from a case to a drawing, which rules name."""
