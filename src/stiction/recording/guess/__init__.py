"""What a file probably means: its columns, its times, its remarks."""
