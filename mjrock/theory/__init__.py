"""Classical rocking theory. This package uses neither stiffness nor MuJoCo."""
