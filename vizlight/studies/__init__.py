"""Speed against error: each study measures both in one run and prints a table."""
