"""A primal-dual interior-point method for bilinear programs, compiled, with a factorisation planned in advance."""
