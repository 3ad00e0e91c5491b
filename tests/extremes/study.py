"""What the campaign consists of: studies, each of one extreme, with points along it.

A point either gives an answer whose error is measured against something else (a closed form, a scaled copy, a reference
run) and must be below a limit, or it is refused with words that say why. Anything else is a failure of floe.
"""
import dataclasses
from typing import Callable, Optional


@dataclasses.dataclass
class Miss:
    """A point that is known to miss its limit: why, and by how much at most, or what floe says. Worse is a failure, and
    so is a point that holds again."""
    cause: str
    error: float = 0.0  # below it, it is the miss that is known
    says: str = ""  # of a refusal where there should be an answer

    def covers(self, found):
        if found.refusal:
            return bool(self.says) and self.says in found.refusal.text
        return found.error is not None and found.error < self.error


@dataclasses.dataclass
class Point:
    label: str  # where on the way to the extreme
    measure: Callable  # of a Floe; gives the error, or an Answer; raises Refusal where floe refuses
    limit: Optional[float] = None  # what the error must stay below; None: a refusal is expected
    says: str = ""  # what a refusal must say; with a limit, either will do
    quick: bool = False  # part of `make check`
    misses: Optional[Miss] = None  # the table shows it


@dataclasses.dataclass
class Study:
    name: str
    extreme: str  # what is driven how far
    against: str  # what the answers are verified against
    points: list
    remark: str = ""  # what the table should say besides


@dataclasses.dataclass
class Answer:
    error: float
    note: str = ""  # as a warning that came along


class Refusal(Exception):
    """floe's own words and its exit code."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code, self.text = code, text


@dataclasses.dataclass
class Found:
    """What came of a point."""
    study: Study
    point: Point
    seconds: float
    error: Optional[float] = None
    note: str = ""
    refusal: Optional[Refusal] = None
    fault: str = ""  # why it fails
    miss: str = ""  # the same, where it is known


def judge(study, point, floe, clock):
    """Measures a point and says whether it is as it has to be."""
    begin = clock()
    found = Found(study, point, 0)
    try:
        answer = point.measure(floe)
        found.error, found.note = (answer.error, answer.note) if isinstance(answer, Answer) else (answer, "")
        if point.limit is None:
            found.fault = f"was not refused (error {found.error:.2g}); expected: {point.says}"
        elif not found.error < point.limit:  # NaN fails
            found.fault = f"error {found.error:.3g}, limit {point.limit:.2g}"
    except Refusal as refusal:
        found.refusal = refusal
        if point.limit is not None and not point.says:
            found.fault = f"was refused ({refusal.code}): {refusal.text}"
        elif point.says not in refusal.text:
            found.fault = f"was refused without {point.says!r}: {refusal.text}"
    except (AssertionError, OSError, KeyError, ValueError) as error:
        found.fault = f"{type(error).__name__}: {error}"
    if point.misses and not found.fault:
        found.fault = f"holds again, against: {point.misses.cause}"
    elif point.misses and point.misses.covers(found):
        found.miss, found.fault = found.fault, ""
    found.seconds = clock() - begin
    return found
