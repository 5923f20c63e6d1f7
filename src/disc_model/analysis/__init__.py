"""What kind of motion a recorded signal shows: Poincare sections, spectra, and the words for them."""
