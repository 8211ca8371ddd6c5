"""Vertex-based ZMP trajectory optimisation (Winkler 2017)."""
