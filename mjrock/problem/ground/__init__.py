"""What moves: records, pulses, ground motions."""
