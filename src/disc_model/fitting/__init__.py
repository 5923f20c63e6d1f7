"""Parameters of a case from measurements: what a case predicts, and the fit by least squares."""
