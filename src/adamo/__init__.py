"""ADAMO: a body in a 3D room for vision-language models, and the benchmark around it."""
