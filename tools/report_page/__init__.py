"""One page of what was measured: reads the files of `vkvol bench` and tools/scaling.py, draws conclusions, draws plots."""
