"""Grammatical evolution: any grammar, any objective; it knows neither robots nor rules."""

from geswarm.ge.engine import (
    CallOrderError,
    CheckpointError,
    Engine,
    FitnessError,
    Individual,
    State,
)
from geswarm.ge.evolve import Objective, Result, Stopped, evolve
from geswarm.ge.grammar import Grammar, GrammarError, geswarm_grammar
from geswarm.ge.inverse import NotASentenceError, genome_of
from geswarm.ge.mapping import Derivation, Genome, Mapper
from geswarm.ge.record import GenerationRecord
from geswarm.ge.settings import Settings, SettingsError
from geswarm.ge.store import RunStore, StoredBest, StoreError

__all__ = [
    "CallOrderError",
    "CheckpointError",
    "Derivation",
    "Engine",
    "FitnessError",
    "GenerationRecord",
    "Genome",
    "Grammar",
    "GrammarError",
    "Individual",
    "Mapper",
    "NotASentenceError",
    "Objective",
    "Result",
    "RunStore",
    "Settings",
    "SettingsError",
    "State",
    "Stopped",
    "StoreError",
    "StoredBest",
    "evolve",
    "genome_of",
    "geswarm_grammar",
]
