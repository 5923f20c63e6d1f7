"""One case from its start to its end: what is asked, what the engine is given, what is kept."""
