"""The motion seen in a force: its cycles, regime and friction, with doubts."""
