"""Pictures: matplotlib figures as inline SVG, and their captions."""
