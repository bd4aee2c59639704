"""What every figure is drawn with: its look, logarithmic axes, SVG that reads anywhere."""
