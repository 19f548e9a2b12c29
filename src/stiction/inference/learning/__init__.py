"""What a library teaches: a summary of features, posteriors by it, and how truthful they are."""
