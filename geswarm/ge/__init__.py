"""Grammatical evolution: any grammar, any objective; it knows neither robots nor rules.

>>> from geswarm.ge import Engine, Grammar, Mapper, Settings, evolve, genome_of
>>> grammar = Grammar.parse('''
... <bits> ::= <bit> <bit> <bit> <bit> <bit> <bit> <bit> <bit>
... <bit>  ::= "0" | "1"
... ''')
>>> engine = Engine(grammar, Settings(population=20, generations=15), seed=1)
>>> def ones(generation, individuals):
...     return [individual.phenotype.count("1") for individual in individuals]
>>> result = evolve(engine, ones)
>>> result.best.phenotype, result.best.fitness
('1 1 1 1 1 1 1 1', 8.0)

A sentence that somebody wrote has a genome, too, and can join in:

>>> Mapper(grammar).map(genome_of(grammar, "1 0 1 0 1 0 1 0")).phenotype
'1 0 1 0 1 0 1 0'
"""

from geswarm.ge.database import StoreError
from geswarm.ge.engine import (
    CallOrderError,
    CheckpointError,
    Engine,
    FitnessError,
    Identity,
    State,
)
from geswarm.ge.evolve import Objective, Result, Stopped, evolve
from geswarm.ge.grammar import Grammar, GrammarError
from geswarm.ge.individual import Individual
from geswarm.ge.inverse import NotASentenceError, genome_of
from geswarm.ge.mapping import Derivation, Genome, Mapper
from geswarm.ge.record import GenerationRecord, fall_in_words
from geswarm.ge.settings import CHOICES, PRESETS, STEERABLE, Settings, SettingsError
from geswarm.ge.steering import Injection, SettingsChange, Steering, StoredSteering
from geswarm.ge.store import RunStore, StoredBest, StoredIndividual

__all__ = [
    "CHOICES",
    "PRESETS",
    "STEERABLE",
    "CallOrderError",
    "CheckpointError",
    "Derivation",
    "Engine",
    "FitnessError",
    "GenerationRecord",
    "Genome",
    "Grammar",
    "GrammarError",
    "Identity",
    "Individual",
    "Injection",
    "Mapper",
    "NotASentenceError",
    "Objective",
    "Result",
    "RunStore",
    "Settings",
    "SettingsChange",
    "SettingsError",
    "State",
    "Steering",
    "Stopped",
    "StoreError",
    "StoredBest",
    "StoredIndividual",
    "StoredSteering",
    "evolve",
    "fall_in_words",
    "genome_of",
]
