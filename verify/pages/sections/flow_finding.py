"""What regions carried by maps show, in sentences: on all of a scene, and on each of them."""

from collections.abc import Iterator, Sequence
from decimal import ROUND_CEILING, Decimal
from fractions import Fraction

from verify.pages.sections.by_key import by_key
from verify.pages.sections.flow_words import Words, words
from verify.pages.text.typography import IS, NBSP, listed, map_name, number, step, whole
from verify.scenes.results.regions import EXACT_FLOW, FlowImage, FlowResult

_SEEN = Fraction(1, 1000)  # of an area: an eye does not see less in a picture; the sentence says it

# -- sentences on all of a scene ------------------------------------------------------------------

FlowFinding = tuple[FlowResult, FlowImage]


def findings(flows: Sequence[FlowResult]) -> Iterator[str]:
    images = [(flow, image) for flow in flows for image in flow.images]
    changing = [each for each in images if each[1].area_preserving is not True]
    known = [each for each in changing if each[1].area_change is not None]
    said = words(flows)
    if known:
        yield _largest(known, said)
        yield _probe(known)
        yield from _means(known, said)
    yield from _preserved([each for each in images if each[1].area_preserving], said)
    yield from _distances([each for each in images if each[1].distance is not None])
    problems = [each for each in images if each[1].problem]
    if problems:
        count = "image has" if len(problems) == 1 else "images have"
        yield (
            f"{whole(len(problems))} {count} no known change of {said.measured}; the table says "
            "why."
        )


def _largest(known: Sequence[FlowFinding], said: Words) -> str:
    flow, image = max(known, key=lambda each: _size(each[1].area_change))
    return (
        f"The largest relative change of {said.measured} is that by {image.map} with "
        f"{_at(flow, image)}: {_change(image)}."
    )


def _probe(known: Sequence[FlowFinding]) -> str:
    """How far below the change the probe's error is, in the worst case."""
    ratios = [
        _size(image.area_change) / Fraction(image.probe_error)
        for _, image in known
        if image.probe_error and Fraction(image.probe_error)
    ]
    if not ratios:
        return "The probe’s own error is 0."
    least = whole(_floor_of(min(ratios)))
    if len(ratios) == 1:
        return f"The probe’s own error is {least} times smaller."
    return f"The probe’s own error is at least {least} times smaller than the change it measures."


def _floor_of(ratio: Fraction) -> int:
    """Two digits, rounded downwards."""
    count = int(ratio)
    unit = int("1" + "0" * max(0, len(str(count)) - 2))
    return count // unit * unit


def _means(known: Sequence[FlowFinding], said: Words) -> Iterator[str]:
    compared = [image for _, image in known if image.agree is not None]
    if not compared:
        return
    apart = sum(not image.agree for image in compared)
    all_of = "In the one image" if len(compared) == 1 else f"In all {whole(len(compared))} images"
    if apart:
        yield (
            f"The mean of {said.mean} over the region, computed without {said.without}, differs "
            f"from it in {whole(apart)} of {whole(len(compared))} images: one of the two is wrong "
            "there."
        )
    else:
        yield (
            f"{all_of} the mean of {said.mean} over the region, computed without {said.without}, "
            f"is the same within the errors, as it must be by {said.equal_by}."
        )


def _preserved(images: Sequence[FlowFinding], words: Words) -> Iterator[str]:
    schemes = list(dict.fromkeys(i.map for _, i in images if i.map != EXACT_FLOW))
    exact = any(image.map == EXACT_FLOW for _, image in images)
    whose = [f"{words.proved} is proved for {listed(schemes)}"] if schemes else []
    if exact:
        whose.append(words.kept)
    measured = [image for _, image in images if image.area_change is not None]
    if not whose or not measured:
        return
    said = " and ".join(whose)
    above = [i for i in measured if _size(i.area_change) > Fraction(i.probe_error or 0)]
    most = max(measured, key=lambda image: Fraction(image.probe_error or 0))
    if above:
        yield (
            f"{_capital(said)}, but for {whole(len(above))} of these images the probe measures a "
            "change that is larger than its error: the probe is wrong there."
        )
        return
    yield (
        f"{_capital(said)}; what the probe measures there is below its own error, at most "
        f"{number(most.probe_error or '0')}."
    )


def _capital(text: str) -> str:
    return text if text.startswith("det") else text[:1].upper() + text[1:]


def _distances(images: Sequence[FlowFinding]) -> Iterator[str]:
    """For each scheme, how far its outlines are from the exact ones at most."""
    parts = []
    for name, own in by_key(images, lambda each: each[1].map).items():
        flow, image = max(own, key=lambda each: _size(each[1].distance))
        parts.append(f"{name} {_away(image)} ({_at(flow, image)})")
    if parts:
        yield f"The outlines’ distance from those by the exact flow: {listed(parts)}."


# -- sentences on one region ----------------------------------------------------------------------


def finding(flow: FlowResult) -> Iterator[str]:
    """The change of area of each scheme after the most steps; what is proved; distances.

    Where the last image failed, the last that is known is told too.
    """
    ascending = sorted(flow.images, key=lambda image: image.steps)
    for name, images in by_key(ascending, lambda image: image.map).items():
        known = [image for image in images if image.area_change is not None]
        if name != EXACT_FLOW:
            yield from (_finding_of(flow, each) for each in known[-1:] if each is not images[-1])
            yield _finding_of(flow, images[-1])
    yield from _by_planes(flow)


def _finding_of(flow: FlowResult, image: FlowImage) -> str:
    start = f"{image.map} with {_at(flow, image)}"
    said = words([flow])
    if image.area_change is None:
        why = image.problem or "none was measured"
        return f"{start}: no change of {said.measured} is known ({why})."
    away = ""
    if image.distance is not None:
        away = f" Its outlines are {_away(image)} away from the exact ones."
    if image.area_preserving:
        change = f"(measured: {_change(image)})"
        return f"{start} keeps {_measured(flow)} by proof {change}.{away}"
    most = _size(image.area_change) + _size(image.probe_error)
    unseen = ", less than the thousandth that a picture can show" if most < _SEEN else ""
    text = f"{start} changes {_measured(flow)} by {_change(image)} of it{unseen}."
    doubt = ""
    if image.agree is False:
        doubt = (
            f" The mean of {said.mean} over it, which must be the same, is "
            f"{_pair(*mean_of(image))}: one of the two is wrong."
        )
    return f"{text}{doubt}{away}"


def mean_of(image: FlowImage) -> tuple[str | None, str | None]:
    """The mean of Λ, or of W in n degrees of freedom, and its error."""
    if image.mean_defect is not None:
        return image.mean_defect, image.mean_defect_error
    return image.mean_lambda, image.mean_lambda_error


def _measured(flow: FlowResult) -> str:
    said = words([flow]).measured
    return f"{said} around {region_of(flow)}" if flow.plane else f"the {said} of {region_of(flow)}"


def _by_planes(flow: FlowResult) -> Iterator[str]:
    """What of ∮ p·dq lies in which plane at last, by the first map that has an image."""
    images = [image for image in flow.images if image.outlines and image.outlines[0].projections]
    if not images:
        return
    last = max((i for i in images if i.map == images[0].map), key=lambda image: image.steps)
    seen = last.outlines[0].projections
    planes = listed([f"(q{x.plane}, p{x.plane})" for x in seen])
    areas = listed([f"{float(x.area):.4g}".replace("-", "−") for x in seen])
    yield (
        f"After N{IS}{whole(last.steps)} steps by {map_name(last.map)} the projections to "
        f"{planes} enclose {areas} of what the outline enclosed in (q{flow.plane}, p{flow.plane}) "
        "before: their sum is the invariant, not each of them."
    )


def region_of(flow: FlowResult) -> str:
    """The region whose area it is: the first outline's."""
    name = flow.before[0].name if flow.before else flow.shape
    return f"the {flow.shape}" if name == flow.shape else f"the {flow.shape}’s {name}"


# -- numbers --------------------------------------------------------------------------------------


def _size(text: str | None) -> Fraction:
    return abs(Fraction(text or 0))


def _at(flow: FlowResult, image: FlowImage) -> str:
    return f"h{IS}{step(flow.step_size)}, N{IS}{whole(image.steps)}"


def _change(image: FlowImage) -> str:
    return _pair(image.area_change, image.probe_error)


def _away(image: FlowImage) -> str:
    """A distance with its error; where that is as large, only what the two bound together."""
    found, error = _size(image.distance), _size(image.distance_error)
    if error < found:
        return f"up to {_pair(image.distance, image.distance_error)}"
    return f"at most {number(_rounded_up(found + error))}"


def _rounded_up(value: Fraction) -> str:
    """A bound with two digits."""
    exact = Decimal(value.numerator) / Decimal(value.denominator)
    return f"{exact.quantize(Decimal((0, (1,), exact.adjusted() - 1)), ROUND_CEILING):.1e}"


def _pair(value: str | None, error: str | None) -> str:
    """value ± error."""
    if value is None:
        return "–"
    return number(value) if error is None else f"{number(value)}{NBSP}±{NBSP}{number(error)}"
