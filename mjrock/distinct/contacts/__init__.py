"""The force of a contact line: normal, along the face, and of mortar, with what happens inside a step."""
