"""What a joint is: its stiffness, friction, damping and mortar, given for all joints or for each."""
