"""Laws of links of one's own, for tests: they are imported by workers too."""

import math

import mjrock as mr


@mr.link_law
class Gap:
    """A stop that pushes where it is shorter by more than a gap."""

    k: float
    gap: float

    def force(self, u, rate):
        return self.k * min(u + self.gap, 0.0)

    def energy(self, u):
        return 0.5 * self.k * min(u + self.gap, 0.0) ** 2


@mr.link_law
class Relief:
    """A dashpot whose force grows like c v up to a relief force, beyond which a valve opens."""

    c: float
    relief: float

    def force(self, u, rate):
        return self.relief * math.tanh(self.c * rate / self.relief)

    def energy(self, u):
        return 0.0


@mr.link_law
class Slider:
    """A spring in a row with a slider that slips both ways."""

    k: float
    slips_at: float
    memory = ("slid",)

    def remember(self, u):
        most = self.slips_at / self.k
        self.slid = min(max(self.slid, u - most), u + most)

    def force(self, u, rate):
        return self.k * (u - self.slid)

    def energy(self, u):
        return 0.5 * self.k * (u - self.slid) ** 2


@mr.link_law
class Spring:
    """A spring with a prestress."""

    k: float
    prestress: float

    def force(self, u, rate):
        return self.k * u + self.prestress

    def energy(self, u):
        return 0.5 * self.k * u * u + self.prestress * u
