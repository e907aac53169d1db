"""A contact of two geoms in N/m and N s/m, as numbers, as text, and written into a model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import quoteattr

import mujoco

from ..quantities import require_flag
from .geoms import GeomPair, compiled
from .notes import missing, spoilers
from .numbers import ContactNumbers


@dataclass(frozen=True)
class PairContact(ContactNumbers):
    """A spring and dashpot between two geoms that never pull, and the numbers with which MuJoCo has them.

    Its numbers are those of `ContactNumbers`.
    """

    @property
    def xml(self) -> str:
        """The elements to put into `<mujoco>`: the options that the contact needs, and the explicit pair.

        Put it behind every other `<option>`, because the last one is taken, and in place of any `<pair>` of the same
        geoms, because MuJoCo makes the contacts of both. Of several contacts keep one `<option>`, with the largest
        impratio. An impratio of 1e6 to 1e9 is normal here.

        Raises:
            ValueError: if one of the geoms has no name.
        """
        return document([self])

    def apply(self, model: mujoco.MjModel | mujoco.MjSpec, *, on_geoms: bool = False) -> None:
        """Write the contact into a model, with the options that it needs.

        A compiled model has to have an explicit `<pair>` of the two geoms, which takes the numbers. A specification
        that has none is given one. The time step is set, and for a contact with friction the elliptic cone and
        impratio, which keeps its value if that is larger.

        Args:
            model: the model for which the contact was made, or another with the same geoms and bodies. It is changed.
            on_geoms: whether the two geoms of a compiled model without such a pair take the numbers. An approach
                without sliding is then the same. Geoms have no solreffriction, so that sliding changes the normal
                force, and every other contact of these geoms mixes the numbers too.

        Raises:
            ValueError: if a compiled model has no such pair, a geom has no name where a name is needed, or the bodies
                have another inverse weight.
        """
        write([self], model, on_geoms)

    def put_into(self, model: mujoco.MjModel | mujoco.MjSpec, whole: mujoco.MjModel, on_geoms: bool) -> None:
        """Write the pair into a model or a specification, of which `whole` is the compiled model; not the options."""
        geoms = self._pair_in(whole)
        if isinstance(model, mujoco.MjSpec):
            self._require_names()
            self._write_spec(model, geoms)
        elif geoms.explicit >= 0:
            self._write_pair(model, geoms.explicit)
        elif on_geoms:
            self._write_geoms(model)
        else:
            raise ValueError(
                f"model has no explicit <pair> of {self.geom1 or self.ids[0]!r} and {self.geom2 or self.ids[1]!r}; "
                "apply the contact to its MjSpec before compiling, put the text of .xml into the MJCF, or let both "
                "geoms take it with on_geoms=True"
            )

    @property
    def pair_xml(self) -> str:
        """The explicit pair alone, as text; ValueError if one of the geoms has no name."""
        self._require_names()
        numbers = {"solref": self.solref, "solimp": self.solimp}
        if self.condim > 1:
            numbers |= {"solreffriction": self.solreffriction, "friction": self.friction}
        attributes = " ".join(f"{name}={_text(*values)}" for name, values in numbers.items())
        geoms = f"geom1={quoteattr(self.geom1)} geom2={quoteattr(self.geom2)}"
        return f'<pair {geoms} condim="{self.condim}" {attributes}/>'

    def _write_spec(self, spec: mujoco.MjSpec, geoms: GeomPair) -> None:
        named = (pair for pair in spec.pairs if {pair.geomname1, pair.geomname2} == {*geoms.names})
        pair = next(named, None) or spec.add_pair(geomname1=self.geom1, geomname2=self.geom2)
        pair.condim, pair.friction = self.condim, self.friction
        pair.solref, pair.solimp, pair.solreffriction = self.solref, self.solimp, self.solreffriction

    def _write_pair(self, model: mujoco.MjModel, i: int) -> None:
        model.pair_dim[i], model.pair_friction[i] = self.condim, self.friction
        model.pair_solref[i], model.pair_solimp[i] = self.solref, self.solimp
        model.pair_solreffriction[i] = self.solreffriction

    def _write_geoms(self, model: mujoco.MjModel) -> None:
        """Equal geoms of equal priority mix to what they are."""
        geoms = list(self._pair_in(model).geoms)
        model.geom_solref[geoms], model.geom_solimp[geoms] = self.solref, self.solimp
        model.geom_condim[geoms], model.geom_friction[geoms] = self.condim, self.friction[1:4]
        model.geom_priority[geoms] = model.geom_priority[geoms].max()

    def caveats(self, model: mujoco.MjModel | mujoco.MjSpec) -> tuple[str, ...]:
        """What in a model keeps the contact from being what it says, one sentence each; empty if nothing does.

        The model is one with the contact, from `apply` or from the text of `xml`.

        Raises:
            ValueError: if the geoms are not in the model, or the bodies have another inverse weight.
        """
        pair = self._pair_in(compiled(model))
        return (*missing(pair, self), *spoilers(pair, self), *self.remarks)

    def _pair_in(self, model: mujoco.MjModel) -> GeomPair:
        """The pair in a model, which has to be the same two bodies."""
        pair = GeomPair.named(model, self.geom1 or self.ids[0], self.geom2 or self.ids[1])
        if not math.isclose(pair.inverse_weight, self.inverse_weight, rel_tol=1e-9):
            raise ValueError(
                f"model has the inverse weight {pair.inverse_weight:.9g} 1/kg for these geoms, and the contact was "
                f"made for {self.inverse_weight:.9g} 1/kg; make the contact for this model"
            )
        return pair

    def _require_names(self) -> None:
        if not (self.geom1 and self.geom2):
            raise ValueError(
                f"geom1 or geom2 (numbers {self.ids}) has no name, which an explicit <pair> needs; "
                "name it, or let both geoms of a compiled model take the contact with apply(model, on_geoms=True)"
            )


def _text(*values: float) -> str:
    return f'"{" ".join(repr(float(value)) for value in values)}"'


def write(contacts: Sequence[PairContact], model: mujoco.MjModel | mujoco.MjSpec, on_geoms: bool) -> None:
    """Write contacts of one time step into a model or a specification."""
    whole, on_geoms = compiled(model), require_flag("on_geoms", on_geoms)
    for contact in contacts:
        contact.put_into(model, whole, on_geoms)
    option = model.option if isinstance(model, mujoco.MjSpec) else model.opt
    option.timestep = contacts[0].timestep
    if any(contact.condim > 1 for contact in contacts):
        option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
        option.impratio = max([float(option.impratio), *(contact.impratio for contact in contacts)])


def document(contacts: Sequence[PairContact]) -> str:
    """The options that contacts of one time step need together, and their explicit pairs."""
    pairs = "".join(f"  {contact.pair_xml}\n" for contact in contacts)
    options = [f"timestep={_text(contacts[0].timestep)}"]
    if any(contact.condim > 1 for contact in contacts):
        options += ['cone="elliptic"', f"impratio={_text(max(contact.impratio for contact in contacts))}"]
    return f"<option {' '.join(options)}/>\n<contact>\n{pairs}</contact>\n"
