"""`mjrock measure model.xml ball floor`: a contact in steps of MuJoCo, compared with its numbers."""

from __future__ import annotations

import argparse
from pathlib import Path

from .geoms import keyframe_argument, load
from .measurement import measure


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command to a parser."""
    parser.add_argument("model", type=Path, help="MJCF or URDF file, or a compiled .mjb")
    parser.add_argument("geoms", nargs=2, metavar="GEOM", help="names of the two geoms, or of bodies with one geom")
    parser.add_argument("--speed", type=float, default=1.0, help="speed of approach of the blows [m/s]")
    parser.add_argument("--duration", type=float, default=1.0, help="how long they rest, and then are pushed [s]")
    parser.add_argument("--keyframe", help="keyframe from which the geoms are moved together, by name or number")
    parser.add_argument("--picture", type=Path, help="file for a picture, which needs Matplotlib")


def answer(args: argparse.Namespace) -> str:
    """The table of the contact; a picture is written where --picture says.

    Raises:
        ValueError, TypeError, OSError: for what the user can mend.
        ImportError: for a picture without Matplotlib.
    """
    keyframe = keyframe_argument(args.keyframe)
    measurement = measure(load(args.model), *args.geoms, speed=args.speed, duration=args.duration, keyframe=keyframe)
    if args.picture is not None:
        measurement.draw().savefig(args.picture, dpi=150)
    return str(measurement)
