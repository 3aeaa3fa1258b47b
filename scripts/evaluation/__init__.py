"""How a textured sequence is judged, from its pictures alone. docs/metrics.md defines every figure."""
