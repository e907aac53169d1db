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


KNET = """Origin Time       2001/02/03 04:05:06
Lat.              35.0
Long.             135.0
Depth. (km)       10
Mag.              5.0
Station Code      XYZ001
Station Lat.      35.1
Station Long.     135.1
Station Height(m) 4
Record Time       2001/02/03 04:05:21
Sampling Freq(Hz) 100Hz
Duration Time(s)  0.06
Dir.              N-S
Scale Factor      2000(gal)/2000
Max. Acc. (gal)   5.000
Last Correction   2001/02/03 04:05:06
Memo.
"""
GEONET = (
    """Corrected accelerogram 20010203_040506_WXYZ_20 GNS Science
Site WXYZ      42 30 00S  172 50 00E
Made Up Valley
Instrument Made_1
Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700
Accelerogram 20010203_040506_WXYZ_20                 Processed 2001 March 04
5 km from nowhere
2001 February 03         04:05:06 UT
Epicentre  42 41 33S 173 01 19E
Number of points  6    Duration 0.05 sec
Instrument corrected data at 0.010 sec intervals
Band-pass filter transition bands are .10-.25 Hz and 24.50-25.50 Hz
Component N10E  Longitudinal Accelerometer Axis
Acceleration:  peak   -50.0 mm/s/s at   0.02 sec     rms     20.0 mm/s/s
Velocity:      peak     1.0 mm/s   at   0.03 sec     rms      1.0 mm/s
Displacement:  peak     0.1 mm     at   0.03 sec     rms      0.1 mm
"""
    + 10 * "    2001       2       3       4       5       6       7       8       9      10\n"
)
CSMIP = """Corrected accelerogram   12345-X0001-01034.01       Chan  1: 360 Deg     from
Uncorrected Accelerogram Data             Processed: 03/04/01
Station No. 12345   37.691N, 122.099W    Made up  s/n  1 (1 Chns of 1 at Sta)
Chan  1: 360 Deg
  6 points of instrument- and baseline-corrected accel, veloc and displ data
Peak acceleration =    -5.000    cm/sec/sec  at    0.020   sec.
    1  100    1    3    3  200    1    3    1   24   12 2500    012345    1    0
  6 points of accel data equally spaced at  .010 sec, in cm/sec2.
"""
COSMOS = (
    "Corrected acceleration    (Format v01.20 with 13 text lines)\nStatn No: 01-12345  Code:XX-WXYZ  Made up\n"
    "Sta Chan  1:  45 deg (Rcrdr Chan  1) Location:\n"
    "   2 Integer-header values follow on  1 lines, Format= (10I8)\n       2       1\n"
    " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n"
    + "".join(f"{10 if i == 61 else -999:15.6f}" + ("\n" if i % 5 == 4 else "") for i in range(100))
    + '   1 Comment line(s) follow, each starting with a "|":\n| made up\n'
    "   6 acceleration pts, approx  0 secs, units=cm/sec2(04)\n"
)
SMC = (
    "2 CORRECTED ACCELEROGRAM\n*\nMADE\n     2001   2   3    0405 Made up\nMoment Mag=      5.0\n"
    "station = Nowhere, 1 Road              component=    270\nepicentral dist =     9.0\n*\n*\n*\n*\n"
    + "".join(
        f"{ {12: 90, 13: 270, 15: 1, 16: 6}.get(i, -32768):10d}" + ("\n" if i % 8 == 7 else "") for i in range(48)
    )
    + "".join(f"{100 if i == 1 else 1.7e38:15.7E}" + ("\n" if i % 5 == 4 else "") for i in range(50))
    + "| made up\n"
)
UNAM = """==========================================================================
ARCHIVO STANDARD DE ACELERACION            : 2.0
NOMBRE DEL ARCHIVO                         : MADE0102.031
CLAVE DE LA ESTACION                       : MADE
COORDENADAS DE LA ESTACION                 : 17.600 LAT. N
                                           : 100.700 LONG. W
ORIENTACION C1-C6 (ORIENTACION;INCLINACION): /N90E
VEL. DE MUESTREO, C1-C6 (muestras/s)       : /100
INTERVALO DE MUESTREO, C1-C6 (s)           : /.01
NUM. TOTAL DE MUESTRAS, C1-C6              : /6
ACEL. MAX.(Gal), C1-C6                     : /5.00
UNIDADES DE LOS DATOS                      : Gal (cm/s/s)
==========================================================================
  CANAL-1
  -------
"""
"""Files of networks, with numbers of their own."""

HEADS = {
    "at2": AT2 + "NPTS= 6, DT= .01 SEC\n",
    "sac": "STA\n6 .01 0 0\n",
    "csv": "t,a\n",
    "esm": esm(),
    "txt": "a\n",
    "knet": KNET,
    "geonet": GEONET,
    "csmip": CSMIP,
    "cosmos": COSMOS,
    "smc": SMC,
    "unam": UNAM,
}
READ = {
    "at2": mr.GroundMotion.from_at2,
    "sac": lambda path: mr.GroundMotion.from_sac(path, "cm/s2"),
    "csv": lambda path: mr.GroundMotion.from_csv(path, "cm/s2"),
    "esm": mr.GroundMotion.from_esm,
    "txt": lambda path: mr.GroundMotion.from_csv(path, "cm/s2", dt=0.01),
} | dict.fromkeys(("knet", "geonet", "csmip", "cosmos", "smc", "unam"), mr.GroundMotion.from_file)
READERS = pytest.mark.parametrize("read", READ.values(), ids=READ)
FORMATS = pytest.mark.parametrize("ending", READ)


def written(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def body(ending: str) -> str:
    """The samples in the rows of a format."""
    scale = {"at2": 1, "geonet": 1000}.get(ending, 100)
    return "".join(row(ending, 0.01 * i, f"{scale * x:g}") + "\n" for i, x in enumerate(SAMPLES))


def row(ending: str, t: float, value: str, between: str = ",") -> str:
    """The row of a sample in a format: its value as text, after its time [s] where the format has times."""
    return f"{t:.2f}{between}{value}" if ending == "csv" else value
