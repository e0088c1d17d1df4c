"""Control tables of rule sets for the robots of a scenario."""

from geswarm.sim.encoding import fails
from geswarm.sim.library import parts_of
from geswarm.sim.tables import compile_controllers


def controllers_for(controllers, scenario):
    parts = parts_of(scenario)
    return compile_controllers(controllers, fails(scenario, parts), parts)
