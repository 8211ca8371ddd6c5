"""The reduced transcription: exact pendulum motion, loads of feet in contact only, own interior-point solver."""
