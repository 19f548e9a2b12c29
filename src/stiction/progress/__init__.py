"""The progress of long work, and its reports to users."""
