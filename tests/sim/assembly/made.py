"""Parts of components alone, without a scenario that offers them."""

from geswarm.rules import Vocabulary
from geswarm.sim.terms.ground import Ground
from geswarm.sim.terms.parts import Parts


def parts_of(name, percepts, behaviours, first, registers=(), ground=None, **more):
    vocabulary = Vocabulary(
        preconditions=tuple(each.word for each in percepts),
        behaviours=tuple(each.word for each in behaviours),
        internal_states=tuple(each.word for each in registers),
        probabilities=(1.0,),
        initial_behaviour=first.word.name,
        name=name,
    )
    seen = [each.seen_by for each in registers if each.seen_by]
    return Parts(
        name,
        vocabulary,
        percepts,
        sensors=(*dict.fromkeys(each.sensor for each in percepts), *seen),
        behaviours=behaviours,
        first=first,
        ground=ground or Ground(),
        registers=registers,
        **more,
    )
