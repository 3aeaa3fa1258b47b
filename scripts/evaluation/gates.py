"""--require: bounds a sequence must keep."""

import dataclasses

from evaluation.errors import UsageError
from evaluation.metrics import METRICS


@dataclasses.dataclass(frozen=True)
class Gate:
    metric: str
    lower: float | None
    upper: float | None

    def text(self):
        if self.lower is None:
            return f"at most {self.upper:g}"
        return f"at least {self.lower:g}" if self.upper is None else f"{self.lower:g} to {self.upper:g}"

    def check(self, result):
        """The summary's value must keep the bound. What was not computed does not.
        @return a row for the report"""
        value = result["summary"].get(self.metric)
        passed = value is not None and (self.lower is None or value >= self.lower) and (
            self.upper is None or value <= self.upper)
        row = {"metric": self.metric, "value": value, "bound": self.text(), "passed": bool(passed)}
        if value is None:
            row["reason"] = result["not_computed"].get(self.metric, "not computed")
        return row


def _names():
    return [*METRICS, *(f"{name}_max" for name, m in METRICS.items() if m.worst == "max"),
            *(f"{name}_min" for name, m in METRICS.items() if m.worst == "min")]


def parse(text):
    """NAME=BOUND (at most), NAME=LOWER: (at least), NAME=LOWER:UPPER.  @throw UsageError"""
    name, equals, bound = text.partition("=")
    if not equals or name not in _names():
        raise UsageError(f"--require: got \"{text}\", expected METRIC=BOUND; metrics are {', '.join(_names())}")
    lower, colon, upper = bound.rpartition(":")
    try:
        gate = Gate(name, float(lower) if lower else None, float(upper) if upper else None)
    except ValueError:
        gate = Gate(name, None, None)
    if gate.lower is None and gate.upper is None:
        raise UsageError(f"--require: {name}: got \"{bound}\", expected a number (at most), LOWER: or LOWER:UPPER")
    return gate
