"""Grammatical evolution: any grammar, any objective; it knows neither robots nor rules."""

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
from geswarm.ge.grammar import Grammar, GrammarError, geswarm_grammar
from geswarm.ge.individual import Individual
from geswarm.ge.inverse import NotASentenceError, genome_of
from geswarm.ge.mapping import Derivation, Genome, Mapper
from geswarm.ge.record import GenerationRecord
from geswarm.ge.settings import PRESETS, STEERABLE, Settings, SettingsError
from geswarm.ge.steering import Injection, SettingsChange, Steering, StoredSteering
from geswarm.ge.store import RunStore, StoredBest, StoredIndividual

__all__ = [
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
    "genome_of",
    "geswarm_grammar",
]
