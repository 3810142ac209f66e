"""Models behind a network: wires, settings, faults, probe."""
