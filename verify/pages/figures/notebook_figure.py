"""The figures' own class: matplotlib's, which a notebook shows by itself."""

import io

from matplotlib.figure import Figure

_DOTS = 144  # an inch; twice a point, so that it is sharp on a fine screen too


class Drawing(Figure):
    """A matplotlib figure that is shown also where pyplot was never imported."""

    def _repr_png_(self) -> bytes:
        stream = io.BytesIO()
        self.savefig(stream, format="png", dpi=_DOTS)
        return stream.getvalue()
