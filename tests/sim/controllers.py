"""Control tables of rule sets for the robots of a scenario."""

from geswarm.sim.controllers.encoding import fails
from geswarm.sim.controllers.tables import compile_controllers
from geswarm.sim.library.vocabulary import parts_of


def controllers_for(controllers, scenario):
    parts = parts_of(scenario)
    return compile_controllers(controllers, fails(scenario, parts), parts)
