"""From a trajectory to tables: spectra and creep."""
