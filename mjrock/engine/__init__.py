"""The contact law in MuJoCo. This package knows no restitution but that of the law itself."""
