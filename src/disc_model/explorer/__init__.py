"""One page on which merged grid studies, motions and figures are looked at, without a server and without a network."""
