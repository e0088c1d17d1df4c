"""The paper's experiments (section 3.2), repeated: evolve, judge, and hold every claim to the data.

>>> from geswarm.analysis.reproduction import Campaign
>>> results = Campaign.at("runs/reproduction").run()  # doctest: +SKIP
"""

from geswarm.analysis.reproduction.campaign import Campaign, CampaignError
from geswarm.analysis.reproduction.claims import Claim, Verdict, claims, parse_claims
from geswarm.analysis.reproduction.plan import QUICK, Plan
from geswarm.analysis.reproduction.results import Results

__all__ = [
    "QUICK",
    "Campaign",
    "CampaignError",
    "Claim",
    "Plan",
    "Results",
    "Verdict",
    "claims",
    "parse_claims",
]
