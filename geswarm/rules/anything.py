"""A vocabulary that knows every name: for rule sets whose own vocabulary is not known yet."""

from __future__ import annotations

from geswarm.rules.model import Precondition, StateChange, Term
from geswarm.rules.vocabulary import Vocabulary


class _Anything(Vocabulary):
    """Has no error with whatever is well-formed; it can only read, nothing follows from it."""

    def precondition_error(self, precondition: Precondition) -> str | None:  # noqa: ARG002
        return None

    def behaviour_error(self, behaviour: Term) -> str | None:  # noqa: ARG002
        return None

    def change_error(self, change: StateChange) -> str | None:  # noqa: ARG002
        return None


ANYTHING = _Anything((), (), (), (), "")
