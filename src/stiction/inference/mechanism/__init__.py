"""Which mechanism a record is like: rotation of the friction vector, or another one."""
