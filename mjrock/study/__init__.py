"""Many answers: campaigns and their store, fragility, and the calibration of damping laws."""
