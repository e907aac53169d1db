"""Records in all formats, and what reads them."""

from pathlib import Path

import pytest

import mjrock as mr

SAMPLES = [0.0, 0.02, -0.05, 0.04, -0.01, 0.0]
NUMBERS = "0.0 2E-2 -.05 4.0e-02\n  -0.01\n0\n"
AT2 = "PEER NGA STRONG MOTION DATABASE RECORD\nSomewhere, 1/1/99\nACCELERATION TIME SERIES IN UNITS OF G\n"
ESM = {
    "EVENT_NAME": "CENTRAL_ITALY", "EVENT_ID": "EMSC-20160824_0000006", "EVENT_DATE_YYYYMMDD": "20160824",
    "MAGNITUDE_W": "6.0", "MAGNITUDE_L": "", "NETWORK": "IT", "STATION_CODE": "AMT", "STATION_NAME": "Amatrice",
    "VS30_M/S": "", "SAMPLING_INTERVAL_S": "0.010000", "NDATA": "6", "DURATION_S": "0.05", "STREAM": "HGE",
    "UNITS": "cm/s^2", "PGA_CM/S^2": "-5.0", "HEADER_FORMAT": "DYNA 1.2", "DATA_TYPE": "ACCELERATION",
}  # fmt: skip
"""Fields of the header of a file of ESM, which has 64 of them."""


def esm(**other: str) -> str:
    """The header of a file of ESM with other values in some fields."""
    fields = ESM | other
    return "".join(f"{name}: {value}\n" for name, value in fields.items()) + "".join(
        f"USER{i}: \n" for i in range(64 - len(fields))
    )


HEADS = {
    "at2": AT2 + "NPTS= 6, DT= .01 SEC\n",
    "sac": "STA\n6 .01 0 0\n",
    "csv": "t,a\n",
    "esm": esm(),
    "txt": "a\n",
}
READ = {
    "at2": mr.GroundMotion.from_at2,
    "sac": mr.GroundMotion.from_sac,
    "csv": lambda path: mr.GroundMotion.from_csv(path, "cm/s2"),
    "esm": mr.GroundMotion.from_esm,
    "txt": lambda path: mr.GroundMotion.from_csv(path, "cm/s2", dt=0.01),
}
READERS = pytest.mark.parametrize("read", READ.values(), ids=READ)
FORMATS = pytest.mark.parametrize("ending", READ)


def written(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def body(ending: str) -> str:
    """The samples in the rows of a format."""
    if ending == "csv":
        return "".join(f"{0.01 * i:.2f},{100 * x:g}\n" for i, x in enumerate(SAMPLES))
    return "".join(f"{x * (1 if ending == 'at2' else 100):g}\n" for x in SAMPLES)
