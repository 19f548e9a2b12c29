"""The probable meaning of a file: its columns, its times, its remarks."""
