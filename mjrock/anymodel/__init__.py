"""A contact in N/m for anyone's MuJoCo model. It needs the contact rows of the engine and nothing else of it."""
