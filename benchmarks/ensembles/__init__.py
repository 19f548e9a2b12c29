"""Many runs at once: the paper's case at many misalignments, on all cores."""
