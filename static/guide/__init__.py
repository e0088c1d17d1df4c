"""Reference pages in Markdown, which README and dashboard link to."""
