"""The parts that the sections on orbits share: a view, phrases, pictures."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from verify.pages.figures.captioned_plot import Plot
from verify.pages.sections.section import Picture, SectionPlace
from verify.pages.sections.table_rows import TableRow
from verify.pages.text.typography import whole
from verify.scenes.results.orbit_points import PoincareOrbit, StroboscopicOrbit

Orbits = Sequence[PoincareOrbit] | Sequence[StroboscopicOrbit]


@dataclass(frozen=True)
class OrbitsView:
    """A picture of orbits, a finding and a table; `source`: the part of a paper that it repeats."""

    anchor: str
    title: str
    finding: str
    rows: tuple[TableRow, ...]
    plot: Plot
    source: str = ""


def pictures(views: Sequence[OrbitsView], rank: int) -> Iterator[Picture]:
    """Yield the picture of each view, for the first screen."""
    for view in views:
        yield Picture((rank,), view.plot, SectionPlace(view.anchor, view.title))


def title_from(source: str, title: str) -> str:
    """Return the title, preceded by `source`, the part of a paper that is repeated, if any."""
    return f"{source}: {title}" if source else title


def describe_partly_known(orbits: Orbits, lost: Orbits, looks: str) -> str:
    """Return a clause on the orbits that are known for a part of the time, and their least time.

    `lost`: these orbits, of `orbits`; `looks`: the unit of the time, a plural.
    """
    least = min(orbit.known for orbit in lost)
    many = f"{whole(len(lost))} of {whole(len(orbits))} orbits"
    part = "is known for a part" if len(lost) == 1 else "are known for a part"
    return f"{many} {part} of the time alone, at least for {whole(least)} {looks}"


def describe_escape(orbit: PoincareOrbit | StroboscopicOrbit) -> str:
    """Return a note that the orbit left every range; "" if it did not."""
    return "it leaves every range" if orbit.left else ""
