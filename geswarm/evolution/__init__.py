"""Where rules, simulator and grammatical evolution meet: evolving rule sets.

>>> from geswarm.evolution import Composition, rule_grammar
>>> from geswarm.ge import Mapper, genome_of
>>> phenotype = "rule if HAS_OBJECT == true do p = 0.1, PHOTOTAXIS"
>>> Mapper(rule_grammar()).map(genome_of(rule_grammar(), phenotype)).phenotype == phenotype
True
>>> Composition().rule_set(phenotype).rules[0].actions
(BehaviourChange(p=0.1, behaviour=Term(name='PHOTOTAXIS', arguments=())),)
"""

from geswarm.evolution.cluster import ClusterError, cluster_executor
from geswarm.evolution.composition import Composition, InjectionError, nearest_offered
from geswarm.evolution.fitness import EvaluationError, ScenarioFitness
from geswarm.evolution.grammar import rule_grammar
from geswarm.evolution.population import Member, Population
from geswarm.evolution.presets import preset_for
from geswarm.evolution.run import EvolutionRun, RunConfig, RunConfigError, version_remarks

__all__ = [
    "ClusterError",
    "Composition",
    "EvaluationError",
    "EvolutionRun",
    "InjectionError",
    "Member",
    "Population",
    "RunConfig",
    "RunConfigError",
    "ScenarioFitness",
    "cluster_executor",
    "nearest_offered",
    "preset_for",
    "rule_grammar",
    "version_remarks",
]
