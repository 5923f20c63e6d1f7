"""What kind of motion a recorded signal shows: sections, spectra, words for them; and Sobol indices of samples."""
