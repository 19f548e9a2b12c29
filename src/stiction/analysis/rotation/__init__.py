"""Whether the friction force turns while the spring is loaded, or grows."""
