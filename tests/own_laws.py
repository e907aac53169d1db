"""Laws of joints of one's own, for tests: they are imported by workers too."""

import math

import mjrock as mr


@mr.joint_law
class Linear:
    """The spring of a dry joint."""

    def stress(self, u):
        return self.k_n * u if u > 0 else 0.0

    def energy(self, u):
        return 0.5 * self.k_n * u * u if u > 0 else 0.0


@mr.joint_law
class Stiffening:
    """k u (1 + u / a)."""

    a: float

    def stress(self, u):
        return self.k_n * u * (1 + u / self.a) if u > 0 else 0.0

    def energy(self, u):
        return self.k_n * u * u * (0.5 + u / (3 * self.a)) if u > 0 else 0.0


@mr.joint_law
class Hertz:
    """k u^1.5 / a^0.5."""

    a: float

    def stress(self, u):
        return self.k_n * u * math.sqrt(u / self.a) if u > 0 else 0.0

    def energy(self, u):
        return 0.4 * self.k_n * u * u * math.sqrt(u / self.a) if u > 0 else 0.0


@mr.joint_law
class HuntCrossley:
    """A dashpot in proportion to the force of the spring, which never pulls."""

    resistance: float

    def stress(self, u):
        return self.k_n * u if u > 0 else 0.0

    def energy(self, u):
        return 0.5 * self.k_n * u * u if u > 0 else 0.0

    def damping(self, u, rate):
        return self.k_n * u * max(self.resistance * rate, -1.0) if u > 0 else 0.0


@mr.joint_law
class Cohesive:
    """Glue that softens linearly from its strength, until it has taken its energy."""

    strength: float
    toughness: float
    memory = ("widest",)

    def remember(self, u):
        self.widest = max(self.widest, -u)

    def stress(self, u):
        if u > 0:
            return self.k_n * u
        first, last = self.strength / self.k_n, 2 * self.toughness / self.strength
        widest = max(self.widest, first)
        left = self.strength * max(last - widest, 0.0) / (last - first)
        return left * u / widest

    def energy(self, u):
        if u > 0:
            return 0.5 * self.k_n * u * u
        first, last = self.strength / self.k_n, 2 * self.toughness / self.strength
        widest = max(self.widest, first)
        left = self.strength * max(last - widest, 0.0) / (last - first)
        return 0.5 * left * u * u / widest

    def lost(self):
        first, last = self.strength / self.k_n, 2 * self.toughness / self.strength
        widest = min(max(self.widest, first), last)
        return 1 - (last - widest) / (last - first) * first / widest
