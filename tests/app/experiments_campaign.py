"""A finished campaign in a directory, without the hour that it takes."""

from geswarm.analysis.reproduction import Campaign
from geswarm.analysis.reproduction.report import files_of
from geswarm.analysis.reproduction.results import format_samples
from tests.analysis.reproduction.fabricated import fabricated


def finished_campaign(directory):
    """Ten evolutions of three generations, with the report and all data."""
    results = fabricated()
    campaign = Campaign.at(directory)
    files = {**files_of(results), "data/performance.csv": format_samples(results.performance)}
    for seed, records in zip(campaign.plan.seeds, results.histories.values(), strict=True):
        lines = [records[0].csv_header(), *(record.csv_row() for record in records)]
        files[f"evolution/seed-{seed}/history.csv"] = "\n".join(lines) + "\n"
    for name, text in files.items():
        (directory / name).parent.mkdir(parents=True, exist_ok=True)
        (directory / name).write_text(text, encoding="utf-8")
    return campaign
