"""Winkler et al. 2017: Fast trajectory optimization for legged robots using vertex-based ZMP constraints."""
