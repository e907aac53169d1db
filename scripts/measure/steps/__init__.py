"""How the cost of a step is measured: what versions of the package are asked for, and the floor in plain C."""
