"""The laws with state and the smoothed law, beside what their users would take."""
