"""Sentences on regions carried by maps: on all regions of a scene, and on a single one."""

from collections.abc import Iterator, Sequence
from decimal import ROUND_CEILING, Decimal
from fractions import Fraction

from verify.pages.sections.flow_vocabulary import Words, vocabulary_of
from verify.pages.sections.table_rows import by_key
from verify.pages.text.typography import IS, NBSP, join_and, map_name, number, step, whole
from verify.scenes.results.regions import EXACT_FLOW, FlowImage, FlowResult

# A change by less than this part of an area is invisible in a picture; a sentence says so.
_VISIBLE_SHARE = Fraction(1, 1000)

# -- sentences on all of a scene ------------------------------------------------------------------

FlowFinding = tuple[FlowResult, FlowImage]


def findings(flows: Sequence[FlowResult]) -> Iterator[str]:
    """Yield the sentences on all regions of a scene."""
    images = [(flow, image) for flow in flows for image in flow.images]
    changing = [pair for pair in images if pair[1].area_preserving is not True]
    measured_images = [pair for pair in changing if pair[1].area_change is not None]
    vocabulary = vocabulary_of(flows)
    if measured_images:
        yield _describe_largest_change(measured_images, vocabulary)
        yield _describe_probe_error(measured_images)
        yield from _compare_with_means(measured_images, vocabulary)
    yield from _describe_preserving_maps(
        [pair for pair in images if pair[1].area_preserving], vocabulary
    )
    yield from _describe_distances([pair for pair in images if pair[1].distance is not None])
    problems = [pair for pair in images if pair[1].problem]
    if problems:
        count = "image has" if len(problems) == 1 else "images have"
        yield (
            f"{whole(len(problems))} {count} no known change of {vocabulary.invariant}; the table "
            "says why."
        )


def _describe_largest_change(images: Sequence[FlowFinding], vocabulary: Words) -> str:
    flow, image = max(images, key=lambda pair: _size(pair[1].area_change))
    return (
        f"The largest relative change of {vocabulary.invariant} is that by {image.map} with "
        f"{_step_and_count(flow, image)}: {_format_change(image)}."
    )


def _describe_probe_error(images: Sequence[FlowFinding]) -> str:
    """Return a sentence on the least ratio of a change to the error of its measurement."""
    ratios = [
        _size(image.area_change) / Fraction(image.probe_error)
        for _, image in images
        if image.probe_error and Fraction(image.probe_error)
    ]
    if not ratios:
        return "The probe’s own error is 0."
    least_ratio = whole(_floor_of(min(ratios)))
    if len(ratios) == 1:
        return f"The probe’s own error is {least_ratio} times smaller."
    return (
        f"The probe’s own error is at least {least_ratio} times smaller than the change it "
        "measures."
    )


def _floor_of(ratio: Fraction) -> int:
    """Return the ratio rounded down to two digits, so that "at least" holds."""
    whole_ratio = int(ratio)
    unit = int("1" + "0" * max(0, len(str(whole_ratio)) - 2))
    return whole_ratio // unit * unit


def _compare_with_means(images: Sequence[FlowFinding], vocabulary: Words) -> Iterator[str]:
    compared = [image for _, image in images if image.agree is not None]
    if not compared:
        return
    differing = sum(not image.agree for image in compared)
    in_all = "In the one image" if len(compared) == 1 else f"In all {whole(len(compared))} images"
    if differing:
        yield (
            f"The mean of {vocabulary.defect} over the region, computed without "
            f"{vocabulary.not_used}, differs from it in {whole(differing)} of "
            f"{whole(len(compared))} images: one of the two is wrong there."
        )
    else:
        yield (
            f"{in_all} the mean of {vocabulary.defect} over the region, computed without "
            f"{vocabulary.not_used}, is the same within the errors, as it must be by "
            f"{vocabulary.equal_by}."
        )


def _describe_preserving_maps(images: Sequence[FlowFinding], vocabulary: Words) -> Iterator[str]:
    schemes = list(dict.fromkeys(i.map for _, i in images if i.map != EXACT_FLOW))
    has_exact_flow = any(image.map == EXACT_FLOW for _, image in images)
    reasons = [f"{vocabulary.identity} is proved for {join_and(schemes)}"] if schemes else []
    if has_exact_flow:
        reasons.append(vocabulary.kept_by_flow)
    measured_images = [image for _, image in images if image.area_change is not None]
    if not reasons or not measured_images:
        return
    claim = " and ".join(reasons)
    # A change larger than the probe's error contradicts the proof, so that the probe must be wrong.
    exceeding = [i for i in measured_images if _size(i.area_change) > Fraction(i.probe_error or 0)]
    least_accurate = max(measured_images, key=lambda image: Fraction(image.probe_error or 0))
    if exceeding:
        yield (
            f"{_capital(claim)}, but for {whole(len(exceeding))} of these images the probe "
            "measures a change that is larger than its error: the probe is wrong there."
        )
        return
    yield (
        f"{_capital(claim)}; what the probe measures there is below its own error, at most "
        f"{number(least_accurate.probe_error or '0')}."
    )


def _capital(text: str) -> str:
    return text if text.startswith("det") else text[:1].upper() + text[1:]


def _describe_distances(images: Sequence[FlowFinding]) -> Iterator[str]:
    """Yield a sentence with the greatest distance of each scheme's outlines from the exact ones."""
    parts = []
    for name, scheme_images in by_key(images, lambda pair: pair[1].map).items():
        flow, image = max(scheme_images, key=lambda pair: _size(pair[1].distance))
        parts.append(f"{name} {_format_distance(image)} ({_step_and_count(flow, image)})")
    if parts:
        yield f"The outlines’ distance from those by the exact flow: {join_and(parts)}."


# -- sentences on one region ----------------------------------------------------------------------


def finding(flow: FlowResult) -> Iterator[str]:
    """Yield a sentence on each scheme's image after the most steps, and one on projections.

    If the change is not known for that image, the last one with a known change has a sentence too.
    """
    ascending = sorted(flow.images, key=lambda image: image.steps)
    for name, images in by_key(ascending, lambda image: image.map).items():
        measured_images = [image for image in images if image.area_change is not None]
        if name != EXACT_FLOW:
            yield from (
                _describe_image(flow, measured_image)
                for measured_image in measured_images[-1:]
                if measured_image is not images[-1]
            )
            yield _describe_image(flow, images[-1])
    yield from _describe_projections(flow)


def _describe_image(flow: FlowResult, image: FlowImage) -> str:
    start = f"{image.map} with {_step_and_count(flow, image)}"
    vocabulary = vocabulary_of([flow])
    if image.area_change is None:
        reason = image.problem or "none was measured"
        return f"{start}: no change of {vocabulary.invariant} is known ({reason})."
    distance_note = ""
    if image.distance is not None:
        distance_note = f" Its outlines are {_format_distance(image)} away from the exact ones."
    if image.area_preserving:
        change = f"(measured: {_format_change(image)})"
        return f"{start} keeps {_name_invariant(flow)} by proof {change}.{distance_note}"
    # A bound on the true change.
    change_bound = _size(image.area_change) + _size(image.probe_error)
    unseen = (
        ", less than the thousandth that a picture can show"
        if change_bound < _VISIBLE_SHARE
        else ""
    )
    text = f"{start} changes {_name_invariant(flow)} by {_format_change(image)} of it{unseen}."
    doubt = ""
    if image.agree is False:
        doubt = (
            f" The mean of {vocabulary.defect} over it, which must be the same, is "
            f"{_with_error(*mean_of(image))}: one of the two is wrong."
        )
    return f"{text}{doubt}{distance_note}"


def mean_of(image: FlowImage) -> tuple[str | None, str | None]:
    """Return the mean of Λ, or of W in n degrees of freedom, and its error."""
    if image.mean_defect is not None:
        return image.mean_defect, image.mean_defect_error
    return image.mean_lambda, image.mean_lambda_error


def _name_invariant(flow: FlowResult) -> str:
    invariant = vocabulary_of([flow]).invariant
    return (
        f"{invariant} around {region_of(flow)}"
        if flow.plane
        else f"the {invariant} of {region_of(flow)}"
    )


def _describe_projections(flow: FlowResult) -> Iterator[str]:
    """Yield a sentence on the parts of ∮ p·dq in each plane at the end, by the first map."""
    images = [image for image in flow.images if image.outlines and image.outlines[0].projections]
    if not images:
        return
    last = max((i for i in images if i.map == images[0].map), key=lambda image: image.steps)
    projections = last.outlines[0].projections
    planes = join_and([f"(q{x.plane}, p{x.plane})" for x in projections])
    areas = join_and([f"{float(x.area):.4g}".replace("-", "−") for x in projections])
    yield (
        f"After N{IS}{whole(last.steps)} steps by {map_name(last.map)} the projections to "
        f"{planes} enclose {areas} of what the outline enclosed in (q{flow.plane}, p{flow.plane}) "
        "before: their sum is the invariant, not each of them."
    )


def region_of(flow: FlowResult) -> str:
    """Return the name of the region whose area is measured, that of the first outline."""
    name = flow.before[0].name if flow.before else flow.shape
    return f"the {flow.shape}" if name == flow.shape else f"the {flow.shape}’s {name}"


# -- numbers --------------------------------------------------------------------------------------


def _size(text: str | None) -> Fraction:
    return abs(Fraction(text or 0))


def _step_and_count(flow: FlowResult, image: FlowImage) -> str:
    return f"h{IS}{step(flow.step_size)}, N{IS}{whole(image.steps)}"


def _format_change(image: FlowImage) -> str:
    return _with_error(image.area_change, image.probe_error)


def _format_distance(image: FlowImage) -> str:
    """Return a distance with its error; if the error is not smaller, a bound on the distance."""
    distance, error = _size(image.distance), _size(image.distance_error)
    if error < distance:
        return f"up to {_with_error(image.distance, image.distance_error)}"
    return f"at most {number(_round_up(distance + error))}"


def _round_up(value: Fraction) -> str:
    """Return a bound rounded up to two digits."""
    quotient = Decimal(value.numerator) / Decimal(value.denominator)
    return f"{quotient.quantize(Decimal((0, (1,), quotient.adjusted() - 1)), ROUND_CEILING):.1e}"


def _with_error(value: str | None, error: str | None) -> str:
    """Return value ± error as text."""
    if value is None:
        return "–"
    return number(value) if error is None else f"{number(value)}{NBSP}±{NBSP}{number(error)}"
