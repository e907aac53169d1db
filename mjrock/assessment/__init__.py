"""An assessment as one file: its tables are the public objects, and their keys the arguments."""
