"""Named cases: what a file says of them, running one, all in one file."""
