"""Lists of faults: what is put where, and which tests could see it."""
