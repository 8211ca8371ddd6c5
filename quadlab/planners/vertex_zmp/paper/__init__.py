"""The formulation of Winkler 2017, with additions: quartic CoM spline and loads as variables, CasADi and Ipopt.

Unlike the paper's, intervals follow the phases, loads are parabolas over the three nodes of each polynomial and not
constant between nodes, they may not be negative between the nodes either, and the boxes of the feet hold at the middles
of the polynomials as well and are smaller by ``reach_margin_m``.
"""
