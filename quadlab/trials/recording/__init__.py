"""The trial log: one MCAP file with named scalars at the control rate and a scene that Foxglove draws."""
