"""The words that rules have: those built in and those that a file brings."""
