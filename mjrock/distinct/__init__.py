"""The contact law by explicit steps, for many blocks: the scheme of distinct-element codes. It knows no MuJoCo."""
