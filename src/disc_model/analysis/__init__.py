"""Analysis of recorded signals: Poincaré sections, spectra, classification of motions; and Sobol indices of samples."""
