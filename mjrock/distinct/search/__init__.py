"""Contact search: where blocks meet that have left their joints, and with what law."""
