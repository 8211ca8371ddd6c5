"""Bellicoso, Gehring, Hwangbo, Fankhauser and Hutter 2016."""
