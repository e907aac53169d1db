"""The contact law in MuJoCo. This package knows no restitution."""
