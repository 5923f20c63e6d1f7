"""The explorer: one page that shows merged grid studies, motions and figures, without a server or network."""
