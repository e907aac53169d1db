"""Contacts in N/m for any MuJoCo model. Of the engine it uses the contact rows alone."""
