"""The literal transcription of Winkler 2017: quartic CoM spline and loads as variables, CasADi and Ipopt."""
