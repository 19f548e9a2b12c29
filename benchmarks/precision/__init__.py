"""Work against precision: time against error on the paper's case."""
