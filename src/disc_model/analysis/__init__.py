"""Analysis of recorded signals: Poincaré sections, spectra, classification of motions, and shares
of samples."""
