"""The pages that the dashboard serves beside the arena."""
