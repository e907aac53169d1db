"""Classical rocking theory. This package knows no stiffness and no MuJoCo."""
